"""Matrices of directed trees in sympy: identities, and each held against the compiled law."""

import numpy as np
import pytest
import sympy as sp

from flockana.measures.perception import incidence, random_out_tree, receivers
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.symbolic import spanning_trees as trees
from flockana.sources.jond_2025.theorems.tree_case import tree_case

CHAIN, STAR, MIXED = ((0, 1), (1, 2), (2, 3)), ((0, 1), (0, 2), (0, 3)), ((0, 1), (1, 2), (1, 3), (0, 4))


@pytest.mark.parametrize("edges", [CHAIN, STAR, MIXED])
def test_matrices_are_those_of_the_numeric_side(edges):
    n = len(edges) + 1
    np.testing.assert_array_equal(np.array(trees.incidence_matrix(edges), float), incidence(n, edges))
    np.testing.assert_array_equal(np.array(trees.receiver_matrix(edges), float), receivers(n, edges))


@pytest.mark.parametrize("edges", [CHAIN, STAR, MIXED, ((0, 1), (1, 2), (2, 0)), ((0, 1), (1, 0))])
def test_the_stacked_form_holds_on_any_graph(edges):
    assert trees.stacked_form(edges).holds


@pytest.mark.parametrize("edges", [CHAIN, MIXED, ((0, 1), (1, 2), (2, 0))])
def test_two_signs_are_wrong_and_cancel(edges):
    forms = trees.separation_forms(edges)
    assert {name: form.holds for name, form in forms.items()} == {
        "28": False,
        "28-corrected": True,
        "identity": False,
        "identity-corrected": True,
        "34": True,
    }


@pytest.mark.parametrize("edges", [CHAIN, STAR, MIXED])
def test_the_determinant_factors_on_trees(edges):
    found = trees.tree_characteristic(edges)
    assert found.holds
    weights = {symbol: value for value, symbol in enumerate(sorted(found.result.free_symbols - {trees.S}, key=str), 2)}
    assert sp.degree(found.result.subs(weights), trees.S) == 2 * len(edges)


def test_it_does_not_factor_off_trees():
    """An agent that perceives two others: (W^a is not I then, and the pencil not triangular)."""
    assert not trees.tree_characteristic(((0, 1), (0, 2), (1, 2))).holds


def test_eigenvalues_at_half_once_and_twice_the_spacing():
    half, once, twice = (trees.frozen_eigenvalues(ratio) for ratio in (sp.Rational(1, 2), 1, 2))
    assert sp.simplify(half[0] - (sp.sqrt(5) - 1) / 2) == 0
    assert once == (0, -1)
    assert [sp.re(value) for value in twice] == [-sp.Rational(1, 2)] * 2
    # stronger springs make it worse inside: s² + s − 6
    assert trees.frozen_eigenvalues(sp.Rational(1, 2), mu=6)[0] == 2


@pytest.mark.parametrize("k", range(1, 8))
def test_the_edge_laplacian_of_k_children(k):
    found = trees.symmetric_part(k)
    assert found.holds
    edges = ((0, 1), *((1, 2 + c) for c in range(k)))
    loop = incidence(k + 2, edges).T @ receivers(k + 2, edges)
    assert np.linalg.eigvalsh(loop + loop.T)[0] / 2 == pytest.approx(float(found.result), abs=1e-12)
    assert (float(found.result) < 0.0) is (k >= 5)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_spectrum_at_the_spacing(m):
    found = trees.spacing_spectrum(m)
    assert found.holds
    assert trees.RHO not in found.result.free_symbols
    roots = sp.roots(found.result.subs(trees.MU, 6), trees.S)
    assert roots.get(0, 0) == m - 1
    assert roots.get(-1, 0) == m - 1


def test_edge_matrices_are_those_of_the_law():
    """Sideways to its edges a chain on the line has the stiffness A^s itself: J = -A^s there, with w at the lengths."""
    lengths, rho, mu = np.array([0.7, 1.9, 1.2]), 1.1, 1.6
    law = MinimalFlocking(edges=CHAIN, spacing=rho, mu=mu)
    q = np.zeros((4, 2))
    q[1:, 0] = -np.cumsum(lengths)
    T = np.kron(-incidence(4, CHAIN).T, np.eye(2))
    J = law.jacobian(0.0, q, 0.0 * q)[8:]
    stiffness, damping = (-T @ J[:, part] @ np.linalg.pinv(T) for part in (slice(0, 8), slice(8, 16)))
    w = {f"w_{j}{i}": mu * (1.0 - rho / length) for (j, i), length in zip(CHAIN, lengths, strict=True)}
    expected_s, expected_a = (np.array(matrix.subs(w), float) for matrix in trees.edge_matrices(CHAIN))
    np.testing.assert_allclose(stiffness[1::2, 1::2], expected_s, atol=1e-12)
    np.testing.assert_allclose(damping[1::2, 1::2], expected_a, atol=1e-12)


def test_the_law_has_the_spectrum_that_sympy_derives():
    """Determinant of sI − A at three points, for a random tree at a random point of the manifold, m = 2."""
    edges = random_out_tree(5, np.random.default_rng(2))
    case = tree_case(MinimalFlocking(edges=edges, spacing=1.4, mu=0.8), 5)
    A = case.edge_system(case.on_manifold(np.random.default_rng(0).uniform(-1.0, 1.0, (5, 2))))
    per_edge = sp.lambdify(trees.S, trees.spacing_spectrum(2).result.subs(trees.MU, 0.8))
    for s in (1.0, 2.0 + 1.0j, -2.5j):
        assert np.linalg.det(s * np.eye(len(A)) - A) == pytest.approx(per_edge(s) ** 4, rel=1e-10)
