"""The law of Cucker and Dong: its force by hand, its functional, and the distance that a pair keeps."""

import numpy as np
import pytest
from scipy.optimize import brentq

import flockana as fl
from flockana import CuckerDong, RationalWeight, verify
from tests.refused import refused
from tests.theorems.made_up import statuses

LAW = CuckerDong(RationalWeight(decay=0.0), repulsion=9.0, distance=0.5)
RNG = np.random.default_rng(5)
Q, P = 3.0 * np.arange(4.0)[:, None] + RNG.normal(size=(4, 2)), RNG.normal(size=(4, 2))


def test_the_force_is_the_sum_over_pairs():
    spread = np.sqrt(np.sum((P - P.mean(axis=0)) ** 2))
    u = [
        sum(
            (P[j] - P[i]) + spread * 9.0 * 0.125 / (np.sum((Q[i] - Q[j]) ** 2) - 0.25) ** 2 * (Q[i] - Q[j])
            for j in range(4)
            if j != i
        )
        for i in range(4)
    ]
    np.testing.assert_allclose(LAW.acceleration(0.0, Q, P), u, rtol=1e-13)


def test_the_functional_falls_at_the_rate_of_the_alignment():
    """−Σ_{i<j} a ‖p_j − p_i‖²/V, which is −nV for a = 1."""
    h = 1e-5
    run = fl.simulate(LAW, Q, P, (0.0, h), rtol=1e-12)
    rate = (LAW.functional(run.q[-1], run.p[-1]) - LAW.functional(Q, P)) / h
    assert rate == pytest.approx(-4.0 * np.sqrt(np.sum((P - P.mean(axis=0)) ** 2)), rel=1e-3)


def test_a_pair_turns_back_where_its_functional_lets_it():
    """Without alignment to speak of w' = √2 |w| f x: |w|/√2 + ½G(x²) is kept up to rest, at ½G = E(0)."""
    law = CuckerDong(RationalWeight(1e-9, 0.0), 1.0, 0.5)
    run = fl.simulate(law, [[0.0], [2.0]], [[0.0], [-3.0]], (0.0, 0.6), rtol=1e-9)
    start = law.functional(np.array([[0.0], [2.0]]), np.array([[0.0], [-3.0]]))
    assert start == pytest.approx(3.0 / np.sqrt(2.0) + 0.5 * 0.125 / 3.75, rel=1e-14)
    least = brentq(lambda x: 0.5 * 0.125 / (x * x - 0.25) - start, 0.5 + 1e-9, 2.0)
    assert np.diff(run.q[-1, :, 0])[0] == pytest.approx(least, rel=1e-5)
    verdict = verify("cucker-dong", law=law, q0=[[0.0], [2.0]], p0=[[0.0], [-3.0]], t_span=(0.0, 0.5))
    assert verdict.claim("apart").stated == f"no two agents are nearer than {least:.6g}, δ = 0.5"


def test_a_steep_weight_bounds_slow_flocks_alone():
    """∫ n a(√2 s) ds from 1/√2 on is 2 (π/2 − atan 1)/√2 = π/(2√2) for a = 1/(1 + s²)."""
    law, bound = CuckerDong(RationalWeight(decay=1.0), 0.01, 0.5), np.pi / (2.0 * np.sqrt(2.0))
    q, store = np.array([[0.0], [1.0]]), 0.5 * 0.01 * 0.125 / 0.75
    for side, told in ((1.0 - 1e-6, "verified"), (1.0 + 1e-6, "vacuous")):
        speed = np.sqrt(2.0) * (bound * side - store)
        verdict = verify("cucker-dong", law=law, q0=q, p0=[[0.0], [speed]], t_span=(0.0, 0.5))
        assert statuses(verdict)["flock"] == told
        assert statuses(verdict)["apart"] == "verified"


test_what_is_refused = refused(
    (lambda: CuckerDong(repulsion=-1.0), "repulsion = -1"),
    (lambda: fl.simulate(LAW, [[0.0], [0.5]], [[0.0], [1.0]], (0.0, 1.0)), "agents 0 and 1 are 0.5 apart"),
)
