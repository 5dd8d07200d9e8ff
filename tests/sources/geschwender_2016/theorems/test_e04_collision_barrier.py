"""Erratum E4 and the bounds behind it, against counts made by hand and by brute force."""

import tracemalloc
from itertools import combinations

import numpy as np
import pytest

from flockana import AlphaInteraction
from flockana.equilibria import energy_barrier as bounds
from flockana.lattice import harborth
from flockana.sources.geschwender_2016.theorems import e04_collision_barrier as e04

ALPHA = AlphaInteraction()


@pytest.mark.slow
def test_the_figures_of_the_erratum(verdict_of):
    verdict = verdict_of("E4")
    assert verdict.status == "verified"
    assert (verdict.claim("found").computed, verdict.claim("vacuous").computed) == (14, 23)
    assert verdict.claim("together").computed == {1: [3, 5], 2: [5, 8], 3: [6, 11]}
    assert verdict.claim("together").margin == pytest.approx(ALPHA.far_potential, rel=1e-11)
    barrier = verdict.claim("barrier").computed
    assert barrier[3]["together"] - barrier[3]["ground"] == pytest.approx(52.384, abs=5e-4)
    assert barrier[7]["together"] - barrier[7]["ground"] == pytest.approx(50.176, abs=5e-4)


@pytest.mark.parametrize("reach", [13, 15])
def test_another_largest_lattice_contradicts_the_proof(monkeypatch, reach):
    monkeypatch.setattr(e04, "lattice_reach", lambda alpha: reach)
    claim = e04._reached(ALPHA)
    assert (claim.status, claim.contradicts) == ("inconclusive", "n-max")


def test_the_barrier_at_seven_is_a_count_of_links():
    found = bounds.collision_barrier(ALPHA, 7, starts=6)
    # a hexagon without one agent, its centre doubled: 9 + 5 links and the pair itself leave 6 pairs out of range
    assert found.together == pytest.approx(ALPHA.c_star + 6 * ALPHA.far_potential, abs=1e-8)
    assert found.lowest == pytest.approx((21 - harborth(7)) * ALPHA.far_potential, abs=1e-8)
    distances = np.linalg.norm(found.state[:, None] - found.state[None], axis=2)[np.triu_indices(7, 1)]
    assert np.sum(distances < 1e-7) == 1
    assert ALPHA.potential_energy(found.state) == pytest.approx(found.together, rel=1e-12)


def test_the_barrier_of_nineteen_is_that_of_a_doubled_inner_agent():
    found = bounds.collision_barrier(ALPHA, 19, starts=2)
    links = harborth(18) + 6 + 1
    assert found.height == pytest.approx(ALPHA.c_star - (links - harborth(19)) * ALPHA.far_potential, abs=1e-7)
    assert found.height == pytest.approx(49.440, abs=5e-4)


def test_turan_by_brute_force():
    for n, clique in ((4, 2), (5, 2), (5, 3), (6, 3)):
        pairs, best = list(combinations(range(n), 2)), 0
        for chosen in range(1 << len(pairs)):
            if chosen.bit_count() <= best:
                continue
            edges = {pair for k, pair in enumerate(pairs) if chosen >> k & 1}
            if not any(all(p in edges for p in combinations(group, 2)) for group in combinations(range(n), clique + 1)):
                best = chosen.bit_count()
        assert bounds.turan_pairs(n, clique) == best
    assert all(bounds.turan_pairs(n, 3) == n * n // 3 for n in range(3, 40))


def test_the_bracket_of_lengths_that_lower_v():
    shortest, longest = bounds.bound_range(ALPHA)
    assert (shortest, longest) == (pytest.approx(6.568, abs=5e-4), 8.4)
    assert float(ALPHA.psi_alpha(ALPHA.sigma_norm(shortest))) == pytest.approx(ALPHA.far_potential, rel=1e-9)


@pytest.mark.parametrize(("ratio", "m", "most"), [(1.28, 2, 3), (1.42, 2, 4), (1.62, 2, 5), (1.28, 3, 4), (2.5, 1, 3)])
def test_cliques_are_no_larger_than_known_and_reached(ratio, m, most):
    assert bounds.largest_clique(ratio, m) == most
    angle = 2.0 * np.pi * np.arange(most) / most
    shapes = {1: np.arange(most)[:, None], 2: np.column_stack([np.cos(angle), np.sin(angle)])}
    points = shapes.get(m, np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])).astype(float)
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)[np.triu_indices(len(points), 1)]
    assert distances.max() / distances.min() < ratio


def test_no_random_state_lies_below_the_proved_floor():
    rng = np.random.default_rng(0)
    for n in (4, 9, 25):
        for m in (1, 2, 3):
            clusters = rng.uniform(0.0, 9.0, (4, m))  # near the shape that Turán's graph has
            for q in (rng.uniform(0, 20, (n, m)), clusters[rng.integers(4, size=n)] + rng.normal(0, 0.1, (n, m))):
                assert ALPHA.potential_energy(q) >= bounds.energy_floor(ALPHA, n, m)


def test_n_max_for_every_parameter_set():
    msn, one = AlphaInteraction(15.0, 18.0, 0.1, 0.1, 3.0, 3.0), AlphaInteraction(1.9, 2.8, 0.1, 0.4, 7.0, 9.0)
    reach, none_from = bounds.lattice_reach, bounds.least_infeasible_size
    assert [(reach(a), none_from(a)) for a in (ALPHA, msn, one)] == [(14, 23), (16, 26), (5, 11)]
    assert (reach(ALPHA, 1), none_from(ALPHA, 1), reach(ALPHA, 3)) == (13, 18, None)
    assert reach(AlphaInteraction(7.0, 13.0)) is None  # κ > √3: the triangular lattice is none


def test_collision_bounds_enclose_the_searched_barrier():
    for n in (3, 7):
        low, high = bounds.collision_bounds(ALPHA, n)
        assert low <= bounds.collision_barrier(ALPHA, n, starts=3).together + 1e-9 <= high + 2e-9
    assert bounds.collision_bounds(ALPHA, 1)[0] == np.inf


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [2, 3, 8, 60])
def test_the_agent_of_most_links_is_doubled(n, m):
    q = bounds.coincident_lattice(ALPHA, n, m)
    near = np.linalg.norm(q[1:, None] - q[None, 1:], axis=2) < ALPHA.r
    np.testing.assert_array_equal(q[0], q[1])
    assert near[0].sum() == near.sum(axis=1).max()
    assert len(np.unique(q, axis=0)) == n - 1


def test_bounds_of_a_large_flock_need_no_table_of_all_pairs():
    tracemalloc.start()
    try:
        low, high = bounds.collision_bounds(ALPHA, 4000)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert low < high
    assert peak < 16e6  # a truth value for each of all pairs
