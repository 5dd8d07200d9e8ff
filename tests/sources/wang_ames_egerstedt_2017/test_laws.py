"""The safety filter: its change against a general optimiser, what it may ask for, and both sides of h = 0."""

import numpy as np
import pytest
from scipy.optimize import minimize

import flockana as fl
from flockana.sources.wang_ames_egerstedt_2017.laws import _least_change
from tests.refused import refused

RNG = np.random.default_rng(5)


def pulled(n, **given):
    return fl.SafetyFilter(fl.NetConsensus(np.ones((n, n)) - np.eye(n), 1.0, 0.0), **{"distance": 1.0} | given)


def test_the_barrier_and_the_change_of_a_pair_by_hand():
    """r = 3, r' = -2, c = 2: s = √8, h = √8 - 2; u_i - u_j along e is to be >= -h³ + 4/√8, and is -6."""
    law, q, p = pulled(2), np.array([[0.0], [3.0]]), np.array([[1.0], [-1.0]])
    h, along, least = law.barriers(q, p)
    root = np.sqrt(8.0)
    by_hand = root - 2.0, -1.0, -((root - 2.0) ** 3) + 4.0 / root
    assert (h[0], along[0, 0], least[0]) == pytest.approx(by_hand, rel=1e-14)
    u = law.acceleration(0.0, q, p)
    np.testing.assert_allclose(u, [[-0.5 * least[0]], [0.5 * least[0]]], rtol=1e-14)
    lack = np.array([least[0] + 6.0])
    np.testing.assert_allclose(u - [[3.0], [-3.0]], _least_change(along, ([0], [1]), lack, (2, 1)), rtol=1e-13)
    turning = law.barriers(np.array([[0.0, 0.0], [3.0, 0.0]]), np.array([[0.0, 1.0], [0.0, -1.0]]))[2][0]
    assert turning == pytest.approx(-(root**3) - 4.0 / 3.0, rel=1e-14)  # ‖v‖²/r = 4/3


def test_the_change_of_four_agents_is_the_least():
    law = pulled(4)
    q, p = 1.6 * np.array([[0.0, 0.0], [1.0, 0.1], [0.0, 1.0], [1.1, 1.0]]), RNG.normal(scale=0.3, size=(4, 2))
    _, along, least = law.barriers(q, p)
    (i, j), asked = np.triu_indices(4, 1), law.law.flow(0.0, q, p)[0]

    def room(x):
        return np.sum(along * (x.reshape(4, 2)[i] - x.reshape(4, 2)[j]), axis=1) - least

    met = {"type": "ineq", "fun": room}
    start, options = asked.ravel(), {"ftol": 1e-14}
    best = minimize(lambda x: np.sum((x - start) ** 2), start, constraints=[met], options=options)
    u = law.acceleration(0.0, q, p)
    np.testing.assert_allclose(u.ravel(), best.x, atol=1e-6)
    assert room(u).min() > -1e-12
    assert np.abs(u - asked).max() > 0.1


def test_braking_meets_the_condition_wherever_h_is_not_negative():
    law, asked = pulled(2, acceleration_limit=0.7), []
    for _ in range(400):
        q, p = RNG.normal(size=(2, 2, 2)) * [[[2.0]], [[1.0]]]
        h, _, least = law.barriers(q, p)
        if h[0] >= 0.0 and np.linalg.norm(q[0] - q[1]) > 1.0:
            asked.append(least[0])
    assert len(asked) > 100
    assert max(asked) <= 1.4  # 2α


@pytest.mark.slow
def test_both_sides_of_the_threshold():
    """On a line with r - D = 1 and c = 2 the speed √(2c) = 2 is the threshold."""
    for speed, known, end in ((1.999, ["verified", "vacuous"], 2.0), (2.001, ["vacuous", "verified"], 0.3)):
        run = fl.simulate(pulled(2), [[0.0], [2.0]], [[0.5 * speed], [-0.5 * speed]], (0.0, end))
        verdict = fl.verify("safety-filter", run)
        assert [verdict.claim(name).status for name in ("apart", "too-late")] == known
        assert run.metric("min_distance").min() > 1.0
    bare = fl.simulate(pulled(2).law, [[0.0], [2.0]], [[1.0], [-1.0]], (0.0, 0.5))
    assert bare.metric("min_distance").min() < 1.0  # without the filter


test_bad_input = refused(
    (lambda: pulled(2, distance=0.0), "distance = 0"),
    (lambda: fl.SafetyFilter(fl.Delayed(fl.Algorithm1(), 0.1), 1.0), "law is a Delayed: expected the law without"),
    (lambda: fl.SafetyFilter(fl.AverageConsensus([[0.0]]), 1.0), "expected a continuous law of second order"),
    (lambda: pulled(2).acceleration(0.0, [[0.0], [0.0]], [[0.0], [1.0]]), "agents 0 and 1 are at one place"),
)
