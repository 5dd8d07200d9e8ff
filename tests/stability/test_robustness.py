"""Margins of broken loops: closed forms of one agent, a delay that eats the phase margin, gains that lose stability."""

from math import atan2, degrees, hypot, inf, sqrt

import control
import numpy as np
import pytest
from scipy.sparse import csr_array

from flockana import Algorithm1, Algorithm2, Gains, NetConsensus, StaticTarget, find_equilibrium, linearise
from flockana.lattice import hexagonal_spiral
from flockana.stability.law_studies import robustness_margins
from flockana.stability.linearisation import Linearisation
from flockana.stability.robustness import SEARCHED, loop_margins, open_loop
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
REST = find_equilibrium(LAW, hexagonal_spiral(3, 7.0)).q


def lone(k, d):
    return Algorithm2(gains=Gains(c1_gamma=k, c2_gamma=d), target=StaticTarget((0.0,)))


@pytest.mark.parametrize(("k", "d"), [(4.0, 4.0), (4.0, 1.0), (1.0, 0.3)])
def test_one_agent_in_closed_form(k, d):
    """L = (ds + k)/s²: unit gain at ω² = (d² + √(d⁴ + 4k²))/2, phase margin atan(ωd/k), no gain margin."""
    found = robustness_margins(lone(k, d), [[0.0]])
    omega = sqrt(0.5 * (d * d + hypot(d * d, 2.0 * k)))
    assert found.phase == pytest.approx(degrees(atan2(omega * d, k)), rel=1e-6)
    assert found.gain == (0.0, inf)
    w = np.geomspace(1e-3, 1e3, 200_001)
    peak = np.abs(w * w / (w * w - k - 1j * d * w)).max()
    assert found.sensitivity == pytest.approx(max(peak, 1.0), rel=1e-6)
    balanced = 2.0 / np.abs((-(w * w) - k - 1j * d * w) / (w * w - k - 1j * d * w)).max()  # 2 over the peak of S − T
    assert found.disk == pytest.approx(balanced, rel=1e-6)
    assert found.disk <= balanced * (1.0 + 1e-9)


def test_the_loop_is_that_of_one_input_with_all_others_closed():
    flock = linearise(LAW, REST)
    loop = open_loop(flock, 1, 0)
    closed = loop.A + loop.B @ -loop.C  # closing it gives the flock back
    np.testing.assert_allclose(closed, flock.A, atol=1e-12)
    found = robustness_margins(LAW, REST)
    assert len(found.loops) == REST.size
    assert found.weakest.disk == found.disk <= min(one.disk for one in found.loops)


def sensitivities(k, d, omega):
    """S of each loop by (row of it, the rest): ω² times the diagonal of the inverse of ω² − jωD − K."""
    one = np.eye(len(k))
    return np.array([np.diag(w * w * np.linalg.inv(w * w * one - 1j * w * d - k)) for w in omega])


@pytest.mark.parametrize("law", [LAW, Algorithm1()])
@pytest.mark.parametrize("n", [2, 3, 7])
def test_margins_of_flocks_against_the_inverse_of_their_own_matrix(law, n):
    """S1: a gain is a mass, so that none harms; phase, disk and peak from a fine grid of the second-order form."""
    q = find_equilibrium(law, hexagonal_spiral(n, 7.0)).q
    found, flock = robustness_margins(law, q), linearise(law, q)
    assert found.gain == (0.0, inf)
    omega = np.geomspace(0.03, 300.0, 2001)
    s = sensitivities(flock.stiffness.toarray(), flock.damping.toarray(), omega)
    for index, one in enumerate(found.loops):
        row = s[:, index]
        assert one.sensitivity == pytest.approx(max(1.0, np.abs(row).max()), rel=4e-4)
        assert one.sensitivity >= np.abs(row).max() * (1.0 - 1e-9)
        assert one.disk == pytest.approx(1.0 / np.abs(row - 0.5).max(), rel=4e-4)  # what the grid steps over
        assert one.disk <= 1.0 / np.abs(row - 0.5).max() * (1.0 + 1e-9)
        loop = 1.0 / row - 1.0
        crossing = np.flatnonzero(np.diff(np.sign(np.abs(loop) - 1.0)))
        phases = np.degrees(np.abs(np.angle(-loop[crossing])))
        assert one.phase == pytest.approx(phases.min(), abs=0.6) if phases.size else one.phase >= 179.0


def a_net(seed, n=4):
    """Masses on springs and dampers that act one way: stable, though neither K nor D is symmetric."""
    rng = np.random.default_rng(seed)
    k, d = (rng.uniform(0.0, 1.5, (n, n)) * (rng.random((n, n)) < 0.6) for _ in range(2))
    k, d = (np.diag(x.sum(axis=1) + rng.uniform(0.1, 0.5, n)) - x for x in (k, 1.5 * d))
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-k, -d]])
    links = np.zeros((0, 2), dtype=np.int32)
    return Linearisation(
        LAW, np.arange(n, dtype=float)[:, None], np.zeros((n, 1)), 0.0, 0.0, links, csr_array(a), 1e-12
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_one_way_nets_lose_stability_at_the_gains_that_are_said(seed):
    flock = a_net(seed)
    if not flock.stable:
        return
    n = len(flock.q)
    found = loop_margins(flock)
    for index, one in enumerate(found.loops):
        low, high = one.gain
        for factor in (low * 1.001, low * 1.02, high * 0.98, high * 0.999, low * 0.999, high * 1.001):
            scaled = flock.A.copy()
            scaled[n + index] *= factor
            grows = np.linalg.eigvals(scaled).real.max() > 0.0
            inside = low <= factor <= high
            if SEARCHED[0] < factor < SEARCHED[1] and SEARCHED[0] < low * (low > factor) + high * (high < factor):
                assert grows == (not inside) or (one.gain == SEARCHED)
        for factor in np.geomspace(max(low, 1e-4) * 1.001, min(high, 1e4) * 0.999, 60):
            scaled = flock.A.copy()
            scaled[n + index] *= factor
            assert np.linalg.eigvals(scaled).real.max() < 0.0
        loop = open_loop(flock, index)
        omega = np.geomspace(1e-3, 1e3, 4001)
        data = control.frd(loop, omega)
        phase = control.stability_margins(data)[1]
        if np.isfinite(phase):
            assert one.phase <= abs(phase) + 1e-6


def test_the_bracket_that_was_searched_is_no_infinity():
    """No gain can turn a chain, which is triangular: proved. Of a ring it is searched, and the result says so."""
    n = 3
    links = np.zeros((0, 2), dtype=np.int32)
    for corner, expected in ((0.0, (0.0, inf)), (0.1, SEARCHED)):
        k = np.eye(n) - np.eye(n, k=-1)
        k[0, -1] = -corner
        a = np.block([[np.zeros((n, n)), np.eye(n)], [-k, -5.0 * k]])
        flock = Linearisation(
            LAW, np.arange(n, dtype=float)[:, None], np.zeros((n, 1)), 0.0, 0.0, links, csr_array(a), 1e-12
        )
        assert loop_margins(flock).gain == loop_margins(flock).searched == expected


@pytest.mark.slow
def test_phase_margins_are_what_a_lag_at_the_crossover_takes():
    found = robustness_margins(LAW, REST).weakest
    loop = open_loop(linearise(LAW, REST), found.agent, found.axis)
    w = np.geomspace(0.1, 100.0, 100_001)
    response = np.ravel(loop(1j * w))
    crossing = np.flatnonzero(np.diff(np.sign(np.abs(response) - 1.0)))
    margins = np.abs(np.degrees(np.angle(-response[crossing])))
    assert found.phase == pytest.approx(margins.min(), abs=0.05)


test_bad_input = refused(
    (lambda: robustness_margins(lone(4.0, 0.0), [[0.0]]), "the flock is not stable"),
    (lambda: open_loop(linearise(LAW, REST), 3), "agent = 3, axis = 0: expected one of 3 agents and 2 axes"),
    (lambda: robustness_margins(Algorithm1(), 1.1 * REST), "no equilibrium"),
)


@pytest.mark.parametrize("seed", range(6))
def test_peaks_little_above_one_are_seen_in_every_loop(seed):
    """|S| is 1 at infinity: where that ties with all frequencies tried at first, a hump between them was lost."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 7))
    weights = rng.uniform(0.2, 3.0, (n, n)) * (rng.random((n, n)) < 0.5) * (1.0 - np.eye(n))
    weights[np.arange(n), np.arange(n) - 1] += rng.uniform(0.5, 2.0, n)
    law = NetConsensus(weights, position=rng.uniform(1.0, 5.0), velocity=rng.uniform(3.0, 5.0))
    flock = linearise(law, np.zeros((n, 1)))
    assert flock.stable
    K, D, grid = law.position * law.laplacian, law.velocity * law.laplacian, np.geomspace(1e-3, 1e4, 6001)
    s2 = -(grid**2)[:, None, None]
    S = s2 * np.linalg.inv(s2 * np.eye(n) + 1j * grid[:, None, None] * D + K)
    for k, loop in enumerate(flock.robustness().loops):
        assert loop.sensitivity == pytest.approx(max(1.0, np.abs(S[:, k, k]).max()), rel=2e-5)
        assert loop.sensitivity >= np.abs(S[:, k, k]).max() * (1.0 - 1e-9)
        assert loop.disk == pytest.approx(1.0 / max(0.5, np.abs(S[:, k, k] - 0.5).max()), rel=2e-5)
