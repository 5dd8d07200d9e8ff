"""Absolute tolerances as lengths and speeds, and the longest step."""

import numpy as np
import pytest

import flockana as fl
from flockana.dynamics.error_tolerances import ensure_atol, options_in_units
from tests.refused import refused

Q0, P0 = np.array([[0.0, 0.0], [7.5, 0.0], [3.0, 6.0]]), np.zeros((3, 2))
METHODS = ("DOP853", "RK45", "scipy-DOP853", "Radau", "LSODA")


def test_a_pair_of_tolerances_is_taken_as_a_length_and_a_speed():
    law = fl.Algorithm1()
    run = fl.simulate(law, Q0, P0, (0.0, 1.0), atol=(1e-9, 1e-7))
    assert run.stats["atol"] == (1e-9, 1e-7)
    assert run.floors[:2] == pytest.approx((1e-9, 1e-7), rel=1e-12)
    alone = fl.simulate(law, Q0, P0, (0.0, 1.0), atol=1e-9)
    same = alone.floors
    assert fl.simulate(law, Q0, P0, (0.0, 1.0), atol=tuple(same[:2])).floors == pytest.approx(same, rel=1e-12)


def test_a_run_in_other_units_is_made_with_the_same_steps():
    law, length, time = fl.Algorithm1(), 3.0, 0.25
    run = fl.simulate(law, Q0, P0, (0.0, 2.0), atol=(1e-9, 1e-8), max_step=0.125)
    other = fl.rescale(run, length=length, time=time)
    assert other.stats["atol"] == pytest.approx((3e-9, 12e-8), rel=1e-12)
    assert other.stats["max_step"] == 0.125 * time
    options = options_in_units({"atol": (1e-9, 1e-8), "max_step": 0.125}, length, time)
    again = fl.simulate(other.law, Q0 * length, P0, (0.0, 2.0 * time), **options)
    assert again.stats["steps"] == run.stats["steps"]
    np.testing.assert_allclose(again.q, run.q * length, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_no_step_is_longer_than_asked(method):
    free = fl.simulate(fl.Algorithm1(), [[0.0], [50.0]], [[0.0], [1.0]], (0.0, 1.0), method=method)
    assert np.diff(free.path.t).max() > 0.2
    bound = fl.simulate(fl.Algorithm1(), [[0.0], [50.0]], [[0.0], [1.0]], (0.0, 1.0), method=method, max_step=0.03)
    assert np.diff(bound.path.t).max() <= 0.03 * (1.0 + 1e-12)
    assert bound.stats["max_step"] == 0.03


test_what_cannot_be_asked_for_is_refused = refused(
    ({"atol": (1e-9, 0.0)}, r"atol\[1\] = 0: expected a number > 0"),
    ({"atol": (1e-9,)}, r"expected a length, or a pair \(length, speed\)"),
    ({"max_step": 0.0}, "max_step = 0: expected a number > 0"),
    ({"max_step": 1e-30}, "max_step = 1e-30: too small to change t = 1"),
    ({"method": "RK4", "dt": 0.1, "max_step": 0.1}, "RK4 takes steps of dt; make dt shorter"),
    make=lambda **knobs: fl.simulate(fl.Algorithm1(), Q0, P0, (0.0, 1.0), **knobs),
)


def test_an_absolute_tolerance_may_be_a_length_and_a_speed():
    assert ensure_atol("atol", [1e-9, 1e-8]) == (1e-9, 1e-8)
