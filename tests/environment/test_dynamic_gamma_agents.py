"""γ-agents that are systems: motions in closed form, units, pieces that join, copies, and what is refused."""

import pickle
from math import cos, exp, sin

import numpy as np
import pytest

from flockana import Copies, Spring, SystemTarget, rescale
from flockana.base.errors import ArgumentError, SolverError
from flockana.base.serialize import from_data, to_data
from tests.refused import refused

FREE = Spring((0.0, 0.0), 0.0)
PULLS = Spring((1.0, 2.0), 0.3, 0.1, (0.2, 0.0), 4.0), lambda q, p: np.array([1.0, -p[1]])
FORCES = pytest.mark.parametrize("force", PULLS)


@pytest.mark.parametrize("t", [-30.0, -0.4, 0.0, 3.0, 7.9999, 8.0, 8.0001, 50.0])
def test_a_linear_spring_swings(t):
    """x = 2 cos 0.5t + 6 sin 0.5t about the centre (1, 1)."""
    swing = SystemTarget((3.0, 1.0), (3.0, 0.0), Spring((1.0, 1.0), 0.25))
    q, p = swing.state(t)
    size = 1e-9 * (1.0 + abs(t))
    assert q == pytest.approx([1.0 + 2.0 * cos(0.5 * t) + 6.0 * sin(0.5 * t), 1.0], abs=size)
    assert p == pytest.approx([-sin(0.5 * t) + 3.0 * cos(0.5 * t), 0.0], abs=size)


def test_a_push_against_drag_ends_at_their_ratio():
    fall = SystemTarget((0.0,), (0.0,), Spring((0.0,), 0.0, damping=2.0, push=(6.0,)))
    assert fall.state(40.0)[1] == pytest.approx([3.0], rel=1e-10)
    assert fall.position(1.0) == pytest.approx([3.0 * (1.0 - 0.5 * (1.0 - exp(-2.0)))], rel=1e-10)


def test_a_bounded_spring_keeps_its_energy():
    """½‖p‖² + kℓ²(√(1 + ‖x‖²/ℓ²) − 1), nonlinear, far beyond ℓ."""
    swing = SystemTarget((30.0, 0.0), (0.0, 6.0), Spring((0.0, 0.0), 1.0, reach=5.0))

    def energy(t):
        q, p = swing.state(t)
        return 0.5 * p @ p + 25.0 * (np.sqrt(1.0 + q @ q / 25.0) - 1.0)

    assert [energy(t) for t in (13.0, 61.0, -25.0)] == pytest.approx([energy(0.0)] * 3, rel=1e-10)


@FORCES
def test_p_r_is_the_true_velocity(force):
    target, h = SystemTarget((3.0, 0.0), (0.5, 1.0), force, time=2.0), 1e-3
    for t in (-3.0, 0.0, 0.7, 16.0, 40.0):
        f = target.position
        difference = (8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h)
        np.testing.assert_allclose(target.state(t)[1], difference, atol=1e-6)
    assert target.mismatch([0.0, 3.0]) == 0.0


@FORCES
def test_other_units(force):
    here = SystemTarget((3.0, 0.0), (0.5, 1.0), force)
    there = rescale(here, length=1000.0, time=60.0)
    for t in (0.0, 5.0, 21.0):
        (q, p), (q2, p2) = here.state(t), there.state(60.0 * t)
        np.testing.assert_allclose(q2, 1000.0 * q, rtol=1e-9, atol=1e-7)
        np.testing.assert_allclose(p2, 1000.0 / 60.0 * p, rtol=1e-9, atol=1e-8)


def test_it_can_be_written_and_read():
    target = SystemTarget((3.0, 0.0), (0.5, 1.0), Spring((1.0, 2.0), 0.3, reach=4.0))
    assert from_data(to_data(target)) == target
    copies = Copies([[1.0], [2.0]], [[0.0], [0.0]], Spring((0.0,), 1.0), 1.0, 2.0)
    assert from_data(to_data(copies)) == copies
    with pytest.raises(ArgumentError, match="a user's function has no such form"):
        to_data(SystemTarget((1.0,), (0.0,), lambda q, p: -q))


@pytest.mark.parametrize(("k1", "k2", "k"), [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (0.25, 1.0, -0.09), (0.0, 0.0, -0.04)])
def test_copies_part_as_the_linear_theory_says(k1, k2, k):
    """d'' = −(k + k₁) d − k₂ d' for a copy's distance from the mean; the mean moves as one leader does."""
    rng, t = np.random.default_rng(2), 7.0
    q, p = rng.normal(0.0, 3.0, (5, 2)), rng.normal(0.0, 1.0, (5, 2))
    copies = Copies(q, p, Spring((0.0, 0.0), k), k1, k2)
    leader = SystemTarget(q.mean(axis=0), p.mean(axis=0), Spring((0.0, 0.0), k))
    places = copies.state(t)[0]
    np.testing.assert_allclose(places.mean(axis=0), leader.position(t), atol=1e-9)
    s = np.roots([1.0, k2, k + k1]).astype(complex) + np.array([0.0, 1e-7])  # apart, where they are double
    away, slip = q - q.mean(axis=0), p - p.mean(axis=0)
    a = (slip - s[1] * away) / (s[0] - s[1])
    predicted = (a * np.exp(s[0] * t) + (away - a) * np.exp(s[1] * t)).real
    np.testing.assert_allclose(places - places.mean(axis=0), predicted, atol=1e-5)


def test_copies_of_a_users_function_are_asked_for_one_by_one():
    def force(q, p):
        return -q * np.sqrt(1.0 + q @ q)

    copies = Copies([[1.0, 0.0], [0.0, 2.0]], [[0.0, 0.0], [0.5, 0.0]], force)
    alone = SystemTarget((0.0, 2.0), (0.5, 0.0), force)
    np.testing.assert_allclose(copies.state(5.0)[0][1], alone.position(5.0), atol=1e-9)


test_refusals = refused(
    (lambda: SystemTarget((0.0, 0.0), (1.0,), FREE), "p has 1 component"),
    (lambda: SystemTarget((0.0,), (1.0,), 3.0), "force = 3.0: expected Spring"),
    (lambda: SystemTarget((0.0,), (1.0,), lambda q, p: [1.0, 2.0]), "expected 1 finite components"),
    (lambda: SystemTarget((0.0,), (1.0,), lambda q, p: p / 0.0 * 0.0), "expected 1 finite components"),
    (lambda: SystemTarget((0.0,), (1.0,), FREE, time=0.0), "time = 0: expected a number > 0"),
    (lambda: SystemTarget((0.0, 1.0), (1.0, 0.0), FREE, time=1e308), r"time = 1e\+308: expected about the time"),
    (lambda: Copies([[0.0]], [[0.0]], Spring((0.0,), 0.0), time=1e308), r"time = 1e\+308: expected about the time"),
    (lambda: SystemTarget((1.0, 1.0), (1.0, 0.0), FREE, time=1e-320), "expected about the time"),
    (lambda: Spring((0.0,), 1.0, damping=-1.0), "damping = -1: expected a number >= 0"),
    (lambda: Spring((0.0,), 1.0, reach=0.0), "reach = 0"),
    (lambda: Spring((0.0,), None), "stiffness = None"),
    (lambda: Copies([[0.0]], [[0.0, 1.0]], FREE), "expected equal shapes"),
    (lambda: Copies([[0.0]], [[0.0]], Spring((0.0,), 0.0), position_coupling=-1.0), "position_coupling = -1"),
)


def test_a_motion_that_ends_is_no_motion():
    """q'' = q³ from (1, 1) is infinite soon after: what is asked before stands, what lies beyond is refused."""
    target = SystemTarget((1.0,), (1.0,), lambda q, p: q**3, time=0.01)
    assert np.isfinite(target.position(0.05)).all()
    with pytest.raises(SolverError, match="own motion cannot be integrated beyond t = "), np.errstate(all="ignore"):
        target.position(10.0)


def test_another_process_takes_them_and_finds_the_same_motion():
    spring = Spring((0.0,), 1.0)
    for one in (SystemTarget((1.0,), (0.0,), spring), Copies([[1.0], [2.0]], [[0.0], [0.5]], spring, 0.1, 0.2)):
        here = one.state(20.0)
        there = pickle.loads(pickle.dumps(one))
        assert there == one
        np.testing.assert_array_equal(there.state(20.0), here)


@pytest.mark.parametrize("t", [float("nan"), float("inf"), -float("inf")])
def test_a_time_that_is_none_is_refused(t):
    with pytest.raises(SolverError, match="expected a finite time"):
        SystemTarget((1.0,), (0.0,), Spring((0.0,), 1.0)).position(t)
