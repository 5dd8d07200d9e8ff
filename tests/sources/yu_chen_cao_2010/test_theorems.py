"""Second-order consensus on digraphs: the bound in closed form, and the verdicts against poles of numpy's."""

import numpy as np
import pytest
from flint import fmpq
from hypothesis import given, settings
from hypothesis import strategies as st

import flockana as fl
from flockana.certified import consensus_polynomials


def ring(n):
    return np.roll(np.eye(n), 1, axis=1)


def verdict_of(weights, position, velocity):
    law = fl.NetConsensus(weights, position, velocity)
    n = len(law.weights)
    start = np.arange(2.0 * n).reshape(n, 2) % 3.0
    return fl.verify("net-consensus", fl.simulate(law, start, 0.1 * start[::-1], (0.0, 1.0)))


@pytest.mark.parametrize(("n", "bound"), [(3, 1 / 6), (4, 1 / 2), (5, 0.5 / np.tan(np.pi / 5) ** 2), (6, 3 / 2)])
def test_the_bound_of_a_directed_ring_is_half_the_square_of_a_cotangent(n, bound):
    found = consensus_polynomials.velocity_threshold(
        consensus_polynomials.moving_eigenvalues(consensus_polynomials.laplacian_of(ring(n).tolist()))
    )
    assert found.contains(fmpq(3, 2)) if n == 6 else abs(float(found.mid()) - bound) < 1e-14


@pytest.mark.parametrize(
    ("weights", "position", "velocity", "agrees"),
    [
        (ring(4), 2.0, 1.0, False),  # at equality
        (ring(4), 2.0, 1.0 + 1e-14, True),
        (ring(4), 2.0, 1.0 - 1e-14, False),
        (ring(3), 6.0, 1.0, False),  # at equality
        (np.eye(6, k=-1), 1.0, 1e-3, True),  # a chain: a multiple real eigenvalue
        (np.ones((4, 4)) - np.eye(4), 1.0, 1e-6, True),
        (np.kron(np.eye(2), ring(2)), 1.0, 1.0, False),  # two pairs
        (np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0]]), 1.0, 0.1, True),  # a leader
        (np.array([[0.0, 0, 0], [0, 0, 0], [1, 1, 0]]), 1.0, 1.0, False),  # two leaders
    ],
)
def test_agreement_is_decided_on_both_sides_and_at_equality(weights, position, velocity, agrees):
    verdict = verdict_of(weights, position, velocity)
    expected = ("verified", "vacuous") if agrees else ("vacuous", "verified")
    assert (verdict.claim("consensus").status, verdict.claim("some-start").status) == expected
    assert verdict.rigour == "smt"


@settings(deadline=None, max_examples=25)
@given(st.integers(2, 6), st.integers(0, 10**6), st.floats(0.05, 3.0))
def test_random_nets_agree_exactly_if_their_poles_decay(n, seed, velocity):
    """Poles of numpy's decide, where they are told from the axis."""
    rng = np.random.default_rng(seed)
    weights = np.round(rng.random((n, n)) * (rng.random((n, n)) < 0.5), 2) * (1.0 - np.eye(n))
    laplacian, gain = np.diag(weights.sum(axis=1)) - weights, round(velocity, 3)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-laplacian, -gain * laplacian]])
    real = np.sort(np.linalg.eigvals(A).real)
    moduli = np.sort(np.abs(np.linalg.eigvals(laplacian)))
    if moduli[1] < 1e-6 or abs(real[-3]) < 1e-4:
        return
    stable = consensus_polynomials.stable_off_agreement(consensus_polynomials.laplacian_of(weights.tolist()), 1.0, gain)
    poles = np.linalg.eigvals(A)
    moving = poles[np.argsort(np.abs(poles))[2:]]
    assert stable == bool((moving.real < 0.0).all())
    law = verdict_of(weights, 1.0, gain)
    assert (law.claim("consensus").status == "verified") == stable


def test_hurwitz_by_rouths_array():
    for roots in ([-1, -2, -3], [-1, -2, 1], [-1, 0, -2], [-1 + 2j, -1 - 2j, -4], [2j, -2j, -1]):
        coefficients = [fmpq(round(c.real)) for c in np.poly(roots)[::-1]]
        assert consensus_polynomials.is_hurwitz(coefficients) == all(np.real(root) < 0 for root in roots)


def test_a_gain_of_zero_is_no_such_law_and_another_law_is_none():
    verdict = verdict_of(ring(3), 1.0, 0.0)
    assert verdict.status == "vacuous"
    assert verdict.hypotheses[1].status == "unmet"
    other = fl.simulate(fl.CuckerSmale(), [[0.0], [1.0]], [[0.0], [1.0]], (0.0, 0.1))
    assert fl.verify("net-consensus", other).status == "vacuous"
