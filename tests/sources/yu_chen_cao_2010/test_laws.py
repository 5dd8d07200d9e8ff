"""The linear law of a net: its force, energy, derivatives and motion against closed forms."""

import numpy as np
import pytest
from scipy.linalg import expm

import flockana as fl
from flockana import NetConsensus
from tests.refused import refused

RNG = np.random.default_rng(7)
RING = np.roll(np.eye(4), 1, axis=1)
MIXED = RNG.uniform(0.0, 2.0, (4, 4)) * (1.0 - np.eye(4))
MUTUAL = MIXED + MIXED.T
Q, P = RNG.normal(size=(4, 2)), RNG.normal(size=(4, 2))


@pytest.mark.parametrize("weights", [RING, MIXED, MUTUAL])
def test_the_force_is_the_sum_over_what_is_heard(weights):
    u = np.array([sum(weights[i, j] * (0.7 * (Q[j] - Q[i]) + 1.3 * (P[j] - P[i])) for j in range(4)) for i in range(4)])
    law = NetConsensus(weights, position=0.7, velocity=1.3)
    np.testing.assert_allclose(law.acceleration(0.0, Q, P), u, rtol=0.0, atol=1e-14)


def test_the_energy_of_a_mutual_net_falls_at_its_rate_and_others_have_none():
    law = NetConsensus(MUTUAL, position=0.7, velocity=1.3)
    pairs = sum(MUTUAL[i, j] * np.sum((Q[j] - Q[i]) ** 2) for i in range(4) for j in range(i))
    spread = sum(np.sum((P[i] - P.mean(axis=0)) ** 2) for i in range(4))
    assert law.energy(0.0, Q, P) == pytest.approx(0.35 * pairs + 0.5 * spread, rel=1e-14)
    lost = sum(MUTUAL[i, j] * np.sum((P[j] - P[i]) ** 2) for i in range(4) for j in range(i))
    assert law.energy_rate(0.0, Q, P) == pytest.approx(-1.3 * lost, rel=1e-14)
    run = fl.simulate(law, Q, P, (0.0, 3.0))
    assert np.abs(run.energy_residual).max() < 1e-6 * run.energy()[0]
    one_way = NetConsensus(MIXED)
    assert np.isnan(one_way.energy(0.0, Q, P))
    assert np.isnan(one_way.energy_rate(0.0, Q, P))
    assert (law.conservative, one_way.conservative) == (True, False)


@pytest.mark.parametrize("weights", [RING, MIXED, MUTUAL])
def test_a_run_is_the_exponential_of_the_system(weights):
    law, L = NetConsensus(weights, position=0.7, velocity=1.3), np.diag(weights.sum(axis=1)) - weights
    A = np.block([[np.zeros((4, 4)), np.eye(4)], [-0.7 * L, -1.3 * L]])
    run = fl.simulate(law, Q, P, (0.0, 2.0), rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(np.vstack([run.q[-1], run.p[-1]]), expm(2.0 * A) @ np.vstack([Q, P]), atol=1e-9)
    np.testing.assert_array_equal(law.jacobian(0.0, Q[:, :1], P[:, :1]), A)


def test_poles_of_a_directed_ring_are_those_of_its_eigenvalues():
    """s² + (α + βs) μ = 0 for μ = 1 − e^(2πik/4)."""
    law = NetConsensus(RING, position=1.0, velocity=2.0)
    mu = 1.0 - np.exp(2j * np.pi * np.arange(1, 4) / 4.0)
    roots = np.concatenate([np.roots([1.0, 2.0 * each, each]) for each in mu])
    poles = np.linalg.eigvals(np.asarray(law.jacobian(0.0, np.zeros((4, 1)), np.zeros((4, 1)))))
    moving = poles[np.abs(poles) > 1e-6]
    assert len(moving) == 6
    assert max(np.abs(moving - root).min() for root in roots) < 1e-9


def test_a_saved_run_has_its_law(tmp_path):
    law = NetConsensus(MIXED, position=0.7, velocity=1.3)
    fl.simulate(law, Q, P, (0.0, 0.5)).save(tmp_path / "run.nc")
    assert fl.Trajectory.load(tmp_path / "run.nc").law == law


test_refused = refused(
    (lambda: NetConsensus([[0.0, 1.0]]), r"weights has shape \(1, 2\): expected a square array"),
    (lambda: NetConsensus([[0.0, -1.0], [1.0, 0.0]]), r"weights\[0, 1\] = -1: expected a square array of weights"),
    (lambda: NetConsensus([[1.0, 1.0], [1.0, 0.0]]), r"weights\[0, 0\] = 1: expected 0, as no agent hears itself"),
    (lambda: NetConsensus("ring"), "weights = 'ring': expected a square array"),
    (lambda: NetConsensus(RING, velocity=-1.0), "velocity = -1: expected a number >= 0"),
    (lambda: NetConsensus(RING).acceleration(0.0, Q[:3], P[:3]), "weights are of 4 agents and the state is of 3"),
)
