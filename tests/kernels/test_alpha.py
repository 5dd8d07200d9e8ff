"""Forces, energy and their rates against the dense reference: 1e-12 of the largest force, or of the energy.

The reference sums in another order: n terms of rounding 1e-16 leave three orders of room at n = 1000.
"""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, LinearTarget
from tests.reference import dense

REL = 1e-12
PAIRS = [dense.Pair(), dense.Pair(1.9, 2.8, 0.1, 0.4, 7.0, 9.0), dense.Pair(7.0, 8.4, 0.1, 0.9, 2.0, 30.0)]


def alpha_of(pair):
    return AlphaInteraction(pair.d, pair.r, pair.eps, pair.h, pair.a, pair.b)


def random_state(n, m, seed, spread=None):
    """About five neighbours each."""
    rng = np.random.default_rng(seed)
    spread = 4.0 * n ** (1.0 / m) if spread is None else spread
    return rng.uniform(0.0, spread, (n, m)), rng.normal(0.0, 2.0, (n, m))


def compare(q, p, pair):
    """Algorithms 1 and 2 and their energies against the reference."""
    m, gains = q.shape[1], Gains(c1_alpha=3.0, c2_alpha=0.7, c1_gamma=0.3, c2_gamma=1.9)
    target = LinearTarget(np.arange(1.0, m + 1), np.full(m, 0.5))
    q_r, p_r, t = np.arange(1.0, m + 1) + 0.5 * 2.0, 0.5, 2.0
    one, two = Algorithm1(alpha_of(pair), gains), Algorithm2(alpha_of(pair), gains, target)
    u = dense.acceleration(q, p, pair, 3.0, 0.7)
    assert np.abs(one.acceleration(t, q, p) - u).max() <= REL * max(np.abs(u).max(), 1e-300)
    u -= 0.3 * (q - q_r) + 1.9 * (p - p_r)
    assert np.abs(two.acceleration(t, q, p) - u).max() <= REL * np.abs(u).max()
    v, x = p - p.mean(axis=0), q - q.mean(axis=0)
    potential, dissipation = 3.0 * dense.potential(q, pair), dense.dissipation(q, p, pair)
    assert one.energy(t, q, p) == pytest.approx(potential + 0.5 * np.sum(p * p), rel=REL)
    assert one.structural_energy(q, p) == pytest.approx(potential + 0.5 * np.sum(v * v), rel=REL)
    structural = potential + 0.5 * np.sum(v * v) + 0.3 * 0.5 * np.sum(x * x)
    assert two.energy(t, q, p) == two.structural_energy(q, p) == pytest.approx(structural, rel=REL)
    assert one.energy_rate(t, q, p) == pytest.approx(-0.7 * dissipation, rel=REL)
    assert two.energy_rate(t, q, p) == pytest.approx(-0.7 * dissipation - 1.9 * np.sum(v * v), rel=REL)


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [1, 2, 3, 50])
@pytest.mark.parametrize("pair", PAIRS)
def test_small_flocks(n, m, pair):
    for seed in range(3):
        compare(*random_state(n, m, seed), pair)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_thousand_agents(m):
    compare(*random_state(1000, m, 0, spread=6.0 * 1000 ** (1 / m)), PAIRS[0])


@pytest.mark.parametrize("m", [1, 2, 3])
def test_all_in_one_cell(m):
    compare(*random_state(140, m, 1, spread=3.0), PAIRS[0])


@pytest.mark.parametrize("m", [1, 2, 3])
def test_coincident_agents(m):
    q, p = random_state(40, m, 2)
    q[1] = q[0]
    q[7:10] = q[6]
    compare(q, p, PAIRS[0])
    compare(np.zeros((4, m)), p[:4], PAIRS[1])


@pytest.mark.parametrize("far", [1e9, 1e13])
@pytest.mark.parametrize("n", [20, 200])
def test_one_agent_far_away(n, far):
    q, p = random_state(n, 2, 3)
    q[n // 2] += far
    compare(q, p, PAIRS[0])


@pytest.mark.parametrize("offset", [1e6, -1e10])
def test_a_flock_far_from_the_origin(offset):
    q, p = random_state(200, 2, 4)
    compare(q + offset, p + 1e3, PAIRS[0])


def test_exactly_at_range_and_at_coincidence_by_hand():
    """At distance r nothing acts; at 0 the potential is c*, and the force 0 by symmetry."""
    law = Algorithm1(gains=Gains(c1_alpha=2.0, c2_alpha=1.0))
    still = np.zeros((2, 1))
    assert law.acceleration(0.0, [[0.0], [8.4]], [[0.0], [1.0]]).tolist() == [[0.0], [0.0]]
    assert law.energy(0.0, [[0.0], [8.4]], still) == 2.0 * law.alpha.far_potential
    assert law.energy(0.0, [[5.0], [5.0]], still) == 2.0 * law.alpha.c_star
    u = law.acceleration(0.0, [[5.0], [5.0]], [[0.0], [3.0]])
    assert u.tolist() == [[3.0], [-3.0]]  # a_ij = 1: consensus alone


def test_two_agents_by_hand():
    """ε = 1, distance √24: ‖·‖_σ = 4, √(1 + ε s²) = 5; with h = 0.9 the bump is 1."""
    alpha = AlphaInteraction(d=3.0, r=50.0, eps=1.0, h=0.9, a=5.0, b=5.0)
    law = Algorithm1(alpha, Gains(c1_alpha=1.0, c2_alpha=10.0))
    gap = np.sqrt(24.0)
    s = 4.0 - (np.sqrt(10.0) - 1.0)
    expected = 5.0 * s / np.sqrt(1 + s * s) * gap / 5.0 + 10.0 * (2.0 - (-1.0))
    u = law.acceleration(0.0, [[0.0, 0.0], [gap, 0.0]], [[-1.0, 0.0], [2.0, 0.0]])
    np.testing.assert_allclose(u, [[expected, 0.0], [-expected, 0.0]], rtol=1e-14)
    rate = law.energy_rate(0.0, [[0.0, 0.0], [gap, 0.0]], [[-1.0, 0.0], [2.0, 0.0]])
    assert rate == pytest.approx(-10.0 * 9.0, rel=1e-15)


def test_blocks_do_not_change_the_sums(monkeypatch):
    import flockana.interactions.pair_interaction as module
    from flockana.kernels.neighbours import pair_blocks

    q, p = random_state(300, 2, 9)
    alpha = AlphaInteraction()
    u, rate = alpha.forces(q, p, stiffness=1.0, damping=1.0)
    energy, hessian = alpha.potential_energy(q), alpha.hessian(q).toarray()
    monkeypatch.setattr(module, "pair_blocks", lambda q, r: pair_blocks(q, r, block=1, dense=False))
    u2, rate2 = alpha.forces(q, p, stiffness=1.0, damping=1.0)
    np.testing.assert_allclose(u2, u, atol=REL * np.abs(u).max())
    assert rate2 == pytest.approx(rate, rel=REL)
    assert alpha.potential_energy(q) == pytest.approx(energy, rel=REL)
    np.testing.assert_allclose(alpha.hessian(q).toarray(), hessian, atol=REL * np.abs(hessian).max())
