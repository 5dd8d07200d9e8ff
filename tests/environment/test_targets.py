"""γ-agents: positions by hand, rates against differences, mismatches named."""

from math import pi

import numpy as np
import pytest

from flockana import CallableTarget, CircleTarget, LinearTarget, RescaledVelocity, SineTarget, StaticTarget
from flockana.base.errors import ArgumentError
from tests.refused import refused

MOVING = [
    LinearTarget((200.0, 30.0), (5.0, -1.0)),
    SineTarget((50.0, 40.0), (4.0, 1.0), amplitude=100.0, frequency=0.025, phase=0.3),
    SineTarget((1.0, 2.0, 3.0), (0.0, 0.0, 1.0), amplitude=2.0, frequency=0.7, axis=0),
    SineTarget((1.0,), (2.0,), amplitude=2.0, frequency=0.7, axis=0),
    CircleTarget((50.0, 50.0), 100.0, frequency=0.1, phase=-1.0),
    CircleTarget((5.0, 5.0, 7.0), 3.0, frequency=-0.4),
    CallableTarget(lambda t: ((np.sin(t), t * t), (np.cos(t), 2 * t))),
]


@pytest.mark.parametrize("target", MOVING)
def test_the_rate_is_the_derivative(target):
    """Fourth-order differences: about 1e-11 of the speed."""
    h = 1e-3
    for t in (-3.0, 0.0, 0.7, 12.0):
        f = target.position
        difference = (8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h)
        q, p = target.state(t)
        np.testing.assert_allclose(target.rate(t), difference, atol=1e-7)
        np.testing.assert_array_equal(q, f(t))
        assert q.shape == p.shape == (target.dimension,)
    assert target.mismatch(np.linspace(0.0, 5.0, 7)) <= 1e-8


def test_positions_by_hand():
    assert StaticTarget((5, 6)).state(3.0)[0].tolist() == [5.0, 6.0]
    assert LinearTarget((200.0, 30.0), (5.0, 1.0)).position(2.0).tolist() == [210.0, 32.0]
    sine = SineTarget((10.0, 20.0), (3.0, 0.0), amplitude=2.0, frequency=0.25, phase=pi / 2, axis=1.0)
    np.testing.assert_allclose(sine.position(1.0), [13.0, 20.0], atol=1e-15)
    np.testing.assert_allclose(sine.rate(1.0), [3.0, -pi], rtol=1e-15)
    circle = CircleTarget((1.0, 2.0, 9.0), 4.0, frequency=0.25)
    np.testing.assert_allclose(circle.position(1.0), [1.0, 6.0, 9.0], atol=1e-15)
    np.testing.assert_allclose(circle.rate(1.0), [-2 * pi, 0.0, 0.0], atol=1e-14)


def test_mismatches_are_measured():
    assert StaticTarget((0.0, 0.0), (3.0, 4.0)).mismatch([0.0, 1.0]) == 5.0
    assert StaticTarget((0.0,)).mismatch(0.0) == 0.0
    slow = RescaledVelocity(LinearTarget((0.0,), (2.0,)), 0.25)
    assert slow.state(1.0)[0].tolist() == [2.0]
    assert slow.state(1.0)[1].tolist() == [0.5]
    assert slow.mismatch([0.0]) == 1.5
    wrong = CallableTarget(lambda t: ((t,), (0.0,)))
    assert wrong.mismatch([0.0, 1e6]) == pytest.approx(1.0, rel=1e-9)
    assert wrong.mismatch([]) == 0.0


def test_targets_are_values():
    assert StaticTarget([1, 2]) == StaticTarget(np.array([1.0, 2.0]), np.zeros(2))
    assert hash(CircleTarget([0, 0], 1, 2)) == hash(CircleTarget((0.0, 0.0), 1.0, 2.0))
    target = StaticTarget((1.0, 2.0))
    target.position(0.0)[0] = 99.0
    assert target.position(0.0).tolist() == [1.0, 2.0]


test_bad_targets = refused(
    (lambda: StaticTarget((1.0, 2.0), (1.0,)), "p has 1 components: expected 2"),
    (lambda: StaticTarget((1.0,), 5.0), "p has shape (): expected a vector"),
    (lambda: LinearTarget((1.0, 2.0), (1.0, 2.0, 3.0)), "p has 3 components: expected 2"),
    (lambda: SineTarget((0.0,), (0.0,), 1.0, 1.0), "axis = 1: expected a coordinate of the flock, 0 to 0"),
    (lambda: CircleTarget((0.0,), 1.0, 1.0), "expected 2 or 3 components; a line holds no circle"),
    (lambda: RescaledVelocity("circle", 1.0), "target = 'circle': expected a Target such as CircleTarget(...)"),
    (lambda: RescaledVelocity(StaticTarget((0.0,)), np.nan), "factor = nan: expected a finite number"),
    (lambda: CallableTarget(lambda t: 3), "function(0) failed"),
    (lambda: CallableTarget(lambda t: ((0.0,), (0.0, 0.0))), "gave q_r of 1 and p_r of 2 components"),
    (lambda: CallableTarget(lambda t: ((np.nan,), (0.0,))), "q_r(0) = [nan]: expected finite numbers"),
    exact=True,
)


@pytest.mark.parametrize("time", [1e-6, 1.0, 3600.0])
def test_the_rate_of_a_users_path_is_as_exact_in_every_unit_of_time(time):
    target = CallableTarget(lambda t: ((7.0 * np.cos(t / time), 3.0 * t / time), (0.0, 0.0)), time=time)
    for t in (0.0, 0.4 * time, 50.0 * time):
        expected = np.array([-7.0 * np.sin(t / time), 3.0]) / time
        np.testing.assert_allclose(target.rate(t), expected, rtol=0.0, atol=2e-8 / time)
    with pytest.raises(ArgumentError, match="time = 0: expected a number > 0"):
        CallableTarget(lambda t: ((t,), (1.0,)), time=0.0)


def test_a_function_is_never_called_outside_of_its_span():
    """t² between 1 and 2: three points give its slope at the ends, exactly but for rounding."""

    def function(t):
        assert 1.0 <= t <= 2.0
        return (t * t,), (2.0 * t,)

    target = CallableTarget(function, span=(1.0, 2.0))
    for t in (1.0, 1.000005, 1.5, 2.0):
        assert target.rate(t) == pytest.approx(2.0 * t, abs=1e-9)
    assert (target.dimension, target.position(9.0)) == (1, 4.0)
    assert target.in_units(1.0, 60.0).span == (60.0, 120.0)
    for span in ((1.0, 1.0), (2.0, 1.0), 3, ("a", "b")):
        with pytest.raises(ArgumentError, match="span = "):
            CallableTarget(function, span=span)


def test_what_targets_say_of_themselves():
    """By hand: Aω² and Rω², 1/ω, and p_r = dq_r/dt only where nothing is added or rescaled."""
    sine, circle = SineTarget((0.0, 0.0), (1.0, 0.0), 2.0, 0.25), CircleTarget((0.0, 0.0), 10.0, 0.1)
    for target, consistent, bound, feature in (
        (StaticTarget((0.0,)), True, 0.0, np.inf),
        (StaticTarget((0.0,), (1.0,)), False, 0.0, np.inf),
        (LinearTarget((0.0,), (1.0,)), True, 0.0, np.inf),
        (sine, True, 2.0 * (pi / 2) ** 2, 2.0 / pi),
        (circle, True, 10.0 * (0.2 * pi) ** 2, 5.0 / pi),
        (RescaledVelocity(circle, 0.2), False, 10.0 * (0.2 * pi) ** 2, 5.0 / pi),
        (RescaledVelocity(StaticTarget((0.0,), (1.0,)), 0.2), True, 0.0, np.inf),
        (CallableTarget(sine.state), None, None, None),
        (CallableTarget(sine.state, changes_slower_than=0.5), None, None, 0.5),
    ):
        assert (target.consistent, target.acceleration_bound(0.0), target.feature) == (
            consistent,
            pytest.approx(bound, rel=1e-14) if bound else bound,
            pytest.approx(feature, rel=1e-14) if feature else feature,
        )
        assert target.constant_velocity is (None if bound is None else bound == 0.0)
    assert CallableTarget(sine.state, changes_slower_than=0.5).in_units(1.0, 4.0).feature == 2.0


def test_a_subclass_with_another_motion_loses_the_answers():
    class Turning(LinearTarget):
        def position(self, t):
            return np.array([np.sin(t), 0.0])

    class Named(LinearTarget):
        name = "a line"

    args = (0.0, 0.0), (1.0, 0.0)
    assert (Turning(*args).consistent, Turning(*args).constant_velocity, Turning(*args).feature) == (None, None, None)
    assert (Named(*args).consistent, Named(*args).constant_velocity, Named(*args).feature) == (True, True, np.inf)


def test_a_stated_time_is_positive():
    with pytest.raises(ArgumentError, match=r"changes_slower_than = 0.*> 0"):
        CallableTarget(lambda t: ((t,), (1.0,)), changes_slower_than=0.0)
