"""Consensus of the first order against the exponential of its Laplacian, and the theorem's numbers in closed form."""

import numpy as np
import pytest
from scipy.linalg import expm

import flockana as fl
from flockana import AverageConsensus
from tests.refused import refused

RNG = np.random.default_rng(4)
MIXED = RNG.uniform(0.0, 2.0, (4, 4)) * (1.0 - np.eye(4))
Q = RNG.normal(size=(4, 2))


def test_a_run_is_the_exponential_and_poles_are_the_eigenvalues():
    law = AverageConsensus(MIXED)
    L = np.diag(MIXED.sum(axis=1)) - MIXED
    run = fl.simulate(law, Q, None, (0.0, 2.0), rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(run.q[-1], expm(-2.0 * L) @ Q, atol=1e-10)
    np.testing.assert_allclose(run.u[-1], L @ L @ run.q[-1], atol=1e-9)
    np.testing.assert_array_equal(law.jacobian(0.0, Q[:, :1]), -L)


def ring(n):
    return np.roll(np.eye(n), 1, axis=1) + np.roll(np.eye(n), -1, axis=1)


RINGS = {3: 2.0 / 3.0, 4: 0.5, 5: 4.0 / (5.0 + np.sqrt(5.0))}  # 2/μ, μ the largest
NETS = [(ring(n), limit) for n, limit in RINGS.items()] + [(np.eye(3, k=-1), 2.0), (np.roll(np.eye(5), 1, axis=1), 1.0)]


@pytest.mark.parametrize(("weights", "limit"), NETS)
def test_the_longest_step_is_the_one_at_which_a_multiplier_reaches_the_circle(weights, limit):
    law, n = AverageConsensus(weights), len(weights)
    claim = fl.verify("average-consensus", fl.simulate(law, np.eye(n)[:, :2], None, (0.0, 1.0))).claim("steps")
    assert claim.status == "verified"
    assert claim.computed == pytest.approx(limit, rel=1e-9)
    for share, inside in (
        (0.999, n - 1),
        (1.001, n - 2),
    ):  # of the multipliers, 1 apart: the first to leave, alone or two
        sizes = np.abs(np.linalg.eigvals(np.eye(n) - share * limit * law.laplacian))
        count = np.count_nonzero(sizes < 1.0 - 1e-9)
        assert count == inside if share < 1.0 else count <= inside


def test_the_disagreement_falls_at_the_rate_of_the_symmetric_part():
    """A directed ring of three: λ₂ of (L + Lᵀ)/2 is 3/2, the real part of its poles."""
    law = AverageConsensus(np.roll(np.eye(3), 1, axis=1))
    run = fl.simulate(law, Q[:3], None, (0.0, 3.0))
    claim = fl.verify("average-consensus", run).claim("decay")
    assert claim.status == "verified"
    assert "λ₂ of (L + Lᵀ)/2 = 1.5;" in claim.detail
    assert claim.computed == pytest.approx(np.exp(-4.5), rel=1e-6)  # L is normal: it is attained


def test_an_uneven_net_ends_at_its_left_eigenvector():
    run = fl.scenario("average-weighted").run()
    weights = np.array([0.25, 0.5, 0.5]) / 1.25  # w L = 0
    np.testing.assert_allclose(run.q[-1], np.tile(weights @ run.q[0], (3, 1)), atol=1e-6)


test_bad_input = refused(
    (lambda: AverageConsensus([[0.0, -1.0], [0.0, 0.0]]), r"weights\[0, 1\] = -1: expected a square array"),
    (lambda: fl.simulate(AverageConsensus(ring(3)), Q, None, (0, 1)), "weights are of 3 agents and the state is of 4"),
    (lambda: fl.simulate(AverageConsensus(ring(4)), Q, Q, (0, 1)), "is of first order and has the velocity"),
)
