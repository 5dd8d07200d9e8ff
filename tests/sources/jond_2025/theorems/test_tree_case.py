"""The corrected bearing-distance Theorem 1 by `linearise`: spectrum edge by edge, (n − 1)(m − 1) zero modes."""

import numpy as np
import pytest

from flockana import MinimalFlocking, linearise
from flockana.measures.perception import both_ways, edge_vectors, random_out_tree
from flockana.sources.jond_2025.theorems.tree_case import characteristic_residual, tree_case

STAR, CHAIN, MIXED = ((0, 1), (0, 2), (0, 3)), ((0, 1), (1, 2), (2, 3)), ((0, 1), (1, 2), (1, 3), (0, 4))


def equilibrium(law, n, m, seed=0):
    """A random point of the manifold: bearings at will, every edge at its length, the root at the origin."""
    rng = np.random.default_rng(seed)
    case = tree_case(law, n)
    return case, case.on_manifold(rng.uniform(-1.0, 1.0, (n, m)))


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("edges", [STAR, CHAIN, MIXED])
def test_the_spectrum_is_edge_by_edge(edges, m):
    """The root adds s² in each dimension, the other edges (s² + s + μ_e)(s² + s)^(m − 1)."""
    n = len(edges) + 1
    rho, mu = np.linspace(1.0, 2.0, n), np.linspace(0.5, 3.0, n)
    law = MinimalFlocking(edges=edges, spacing=tuple(rho), mu=np.outer(mu, np.ones(n)))
    case, q = equilibrium(law, n, m)
    np.testing.assert_allclose(np.linalg.norm(edge_vectors(q, edges), axis=1), rho[[i for _, i in edges]], rtol=1e-12)
    found = linearise(law, q)
    factors = [(0.0, 0.0)] * m
    for _, i in edges:
        factors += [(1.0, mu[i])] + [(1.0, 0.0)] * (m - 1)
    # determinants of 2nm <= 30 rows, at points outside the spectrum
    assert characteristic_residual(found.A, factors) < 1e-11
    assert characteristic_residual(case.edge_system(q), factors[m:]) < 1e-11


@pytest.mark.parametrize(("seed", "m"), [(0, 2), (1, 3), (2, 3)])
def test_zero_modes_are_translations_and_one_for_each_free_bearing(seed, m):
    n = 6
    law = MinimalFlocking(edges=random_out_tree(n, np.random.default_rng(seed)), spacing=1.3)
    case, q = equilibrium(law, n, m, seed)
    found = linearise(law, q)
    assert len(found.zero_modes) == m + (n - 1) * (m - 1)
    assert len(found.drifting) == m  # the root keeps its velocity, and nothing else does
    singular = np.linalg.svd(case.edge_system(q), compute_uv=False)
    assert np.sum(singular < 1e-12 * singular[0]) == (n - 1) * (m - 1)
    squared = np.linalg.svd(np.linalg.matrix_power(case.edge_system(q), 2), compute_uv=False)
    assert np.sum(squared < 1e-12 * squared[0]) == (n - 1) * (m - 1)  # semisimple: no Jordan block at zero


@pytest.mark.parametrize(("ratio", "abscissa"), [(0.5, 0.6180339887498949), (1.0, 0.0), (2.0, -0.5)])
def test_two_agents_inside_at_and_outside_the_spacing(ratio, abscissa):
    """Sideways the spring is w = 1 − 1/ratio: (√5 − 1)/2 at half the spacing, as J2 says; on the line always stable."""
    law = MinimalFlocking(edges=((0, 1),), spacing=1.0)
    A = linearise(law, [[0.0, 0.0], [ratio, 0.0]], allow_residual=True).A
    sideways, along = ([1 * 2 + c, 4 + 1 * 2 + c] for c in (1, 0))
    assert np.linalg.eigvals(A[np.ix_(sideways, sideways)]).real.max() == pytest.approx(abscissa, abs=1e-12)
    assert np.linalg.eigvals(A[np.ix_(along, along)]).real.max() == pytest.approx(-0.5)


def test_no_tree_no_case():
    assert tree_case(MinimalFlocking(), 3) is None
    assert tree_case(MinimalFlocking(edges=((0, 1), (1, 2), (2, 0))), 3) is None
    ring = both_ways([(0, 1), (1, 2), (2, 0)])
    assert tree_case(MinimalFlocking(edges=ring, spacing=1.0, normalised=False), 3) is None
    assert tree_case(MinimalFlocking(edges=((0, 1),)), 3) is None  # agent 2 stands apart


@pytest.mark.parametrize("error", [0.0, 1e-3])
def test_an_edge_is_as_long_as_its_ends_may_be_apart(error):
    """Each end is known to an error; V = ½|x'|² + ½μ(|x| − ρ)² at both ends of the length."""
    case = tree_case(MinimalFlocking(edges=((0, 1),), spacing=2.0, mu=3.0), 2)
    length = case.edges_of(np.array([[0.0, 0.0], [0.0, 2.5]]), np.full(2, error))
    assert (length.lo[0], length.hi[0]) == pytest.approx((2.5 - 2.0 * error, 2.5 + 2.0 * error), abs=1e-14)
    energy = case.energies(length, case.edges_of(np.array([[0.0, 0.0], [1.0, 0.0]]), np.zeros(2)))
    ends = [0.5 + 1.5 * (0.5 + sign * 2.0 * error) ** 2 for sign in (-1.0, 1.0)]
    assert (energy.lo[0], energy.hi[0]) == pytest.approx(ends, abs=1e-14)
