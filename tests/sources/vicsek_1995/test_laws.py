"""Averaged headings: the rule agent by agent, the circle that counts, the cut, noise that repeats."""

from math import pi

import numpy as np
import pytest

from flockana import HeadingAveraging, rescale, simulate
from tests.refused import refused

LAW = HeadingAveraging(range=1.0, speed=0.1, dt=0.5)


def start(seed=0, n=9, low=0.3, high=2.8):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, 2.5, (n, 2)), rng.uniform(low, high, n)


def as_written(q, headings, law):
    """One step, agent by agent."""
    after = np.empty(len(q))
    for i in range(len(q)):
        heard = [headings[j] for j in range(len(q)) if np.hypot(*(q[j] - q[i])) <= law.range]
        if law.average == "headings":
            after[i] = sum(heard) / len(heard)
        else:
            after[i] = np.arctan2(sum(np.sin(heard)), sum(np.cos(heard)))
    step = law.speed * law.dt
    return q + step * np.stack([np.cos(headings), np.sin(headings)], axis=1), after


@pytest.mark.parametrize("average", ["headings", "vectors"])
def test_the_rule_as_it_is_written(average):
    law = HeadingAveraging(range=1.0, speed=0.1, dt=0.5, average=average)
    q, headings = start()
    run = simulate(law, q, law.velocities(headings), (0.0, 5.0))
    for k in range(10):
        q, headings = as_written(q, headings, law)
        np.testing.assert_allclose(run.q[k + 1], q, atol=1e-12)
        np.testing.assert_allclose(run.extra["heading"][k + 1], headings, atol=1e-12)
        np.testing.assert_allclose(run.p[k + 1], law.velocities(headings), atol=1e-12)
    np.testing.assert_allclose(run.u[1:], np.diff(run.p, axis=0) / law.dt, atol=1e-12)


def test_who_is_on_the_circle_counts():
    q = np.array([[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [3.0, np.nextafter(1.0, 2.0)]])
    assert LAW.links(q).tolist() == [[0, 1]]


def test_a_mean_never_leaves_its_numbers():
    headings = np.full(7, 0.1) + np.array([0, 0, 0, 1, 0, 0, 0]) * np.spacing(0.1)
    after = LAW.step(0.0, np.zeros((7, 2)), LAW.velocities(headings), {"heading": headings})[3]["heading"]
    assert headings.min() <= after.min() <= after.max() <= headings.max()


def test_headings_are_counted_from_zero():
    q, p = np.zeros((2, 2)), LAW.velocities([0.1, -0.1])
    round_, on = (HeadingAveraging(1.0, 0.1, 0.5, zero=zero) for zero in (0.0, -pi))
    assert round_.start(q, p)["heading"] == pytest.approx([0.1, 2.0 * pi - 0.1])
    assert simulate(round_, q, p, (0.0, 0.5)).p[-1, 0] == pytest.approx([-0.1, 0.0], abs=1e-15)
    assert simulate(on, q, p, (0.0, 0.5)).p[-1, 0] == pytest.approx([0.1, 0.0], abs=1e-15)


def test_vectors_that_cancel_leave_a_heading_alone():
    law = HeadingAveraging(1.0, 0.1, 0.5, average="vectors")
    after = law.step(0.0, np.zeros((2, 2)), np.zeros((2, 2)), {"heading": np.array([0.5, 0.5 + pi])})[3]["heading"]
    assert after.tolist() == [0.5, 0.5 + pi]


@pytest.mark.parametrize(("turn", "points"), [(1.5e-12, False), (3e-12, True)])
def test_what_cancels_is_a_sum_that_is_small_for_the_number_of_vectors(turn, points):
    """Half the agents look along x, half almost against them: each pair leaves a vector of length `turn` along y."""
    law = HeadingAveraging(1.0, 0.1, 0.5, average="vectors")
    headings = np.repeat([0.0, pi - turn], 20)
    after = law.step(0.0, np.zeros((40, 2)), np.zeros((40, 2)), {"heading": headings})[3]["heading"]
    assert after == pytest.approx(np.full(40, pi / 2), abs=1e-2) if points else after.tolist() == headings.tolist()


def test_noise_repeats_and_stays_within_its_width():
    law = HeadingAveraging(1.0, 0.1, 0.5, noise=0.2, seed=3)
    q, headings = start()
    one, again = (simulate(law, q, law.velocities(headings), (0.0, 5.0)) for _ in range(2))
    other = simulate(HeadingAveraging(1.0, 0.1, 0.5, noise=0.2, seed=4), q, law.velocities(headings), (0.0, 5.0))
    assert np.array_equal(one.q, again.q)
    assert not np.array_equal(one.q, other.q)
    for k in range(10):
        quiet = as_written(one.q[k], one.extra["heading"][k], LAW)[1]
        shaken = one.extra["heading"][k + 1] - quiet
        assert 0.01 < np.abs(shaken).max() <= 0.1 + 1e-12


def test_other_units():
    q, headings = start()
    there = rescale(LAW, length=100.0, time=60.0)
    here, moved = (
        simulate(law, scale * q, law.velocities(headings), (0.0, 5.0 * time))
        for law, scale, time in ((LAW, 1.0, 1.0), (there, 100.0, 60.0))
    )
    np.testing.assert_allclose(moved.q, 100.0 * here.q, rtol=1e-12)
    assert here.metric("connectivity").tolist() == moved.metric("connectivity").tolist()


test_bad_parameters = refused(
    ({"range": 0.0}, "range = 0"),
    ({"speed": -1.0}, "speed = -1"),
    ({"dt": float("nan")}, "dt = nan"),
    ({"average": "median"}, "average = 'median': expected one of headings, vectors"),
    ({"noise": 7.0}, "noise = 7: expected at most 2π radians"),
    ({"noise": -1.0}, "noise = -1"),
    ({"seed": 1.5}, "seed = 1.5"),
    ({"zero": float("inf")}, "zero = inf"),
    make=HeadingAveraging,
)


test_bad_starts = refused(
    (
        lambda: simulate(LAW, np.zeros((2, 2)), [[0.1, 0.0], [0.0, 0.0]], (0.0, 1.0)),
        r"agent 1 has the speed 0: expected speed = 0.1 for all agents",
    ),
    (lambda: simulate(LAW, np.zeros((2, 3)), np.zeros((2, 3)), (0.0, 1.0)), "expected the plane, m = 2"),
)
