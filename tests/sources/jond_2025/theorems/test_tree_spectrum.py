"""Spectra of trees whose eigenvalues are known: one directed edge, undirected paths and stars."""

from math import cos, pi, sqrt

import numpy as np
import pytest

from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.theorems.tree_case import tree_case
from flockana.sources.jond_2025.theorems.tree_spectrum import tree_spectrum

EPS = np.finfo(float).eps


def spectrum_of(edges, n, m, **parameters):
    law = MinimalFlocking(edges=edges, spacing=2.0, normalised=False, **parameters)
    case = tree_case(law, n)
    return tree_spectrum(case, case.on_manifold(np.random.default_rng(0).normal(size=(n, m))))


@pytest.mark.parametrize(("mu", "a"), [(3.0, 0.7), (1e6, 400.0), (2.0, 5.0)])
@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_directed_edge_swings_along_itself_and_drifts_across(mu, a, m):
    """s² + a s + μ, and {0, −a} across: in units of 1/√μ the singular values along it have the product 1."""
    found = spectrum_of(((0, 1),), 2, m, mu=mu, sigma=a)
    assert found.zeros == m - 1
    assert found.slowest == pytest.approx(0.5 * (a - sqrt(max(a * a - 4.0 * mu, 0.0))), rel=1e-12)
    assert found.residual < 1e-12
    squares = 2.0 + a * a / mu  # their sum
    largest2 = 0.5 * (squares + sqrt(squares**2 - 4.0))
    assert found.margin == pytest.approx(1.0 / largest2, rel=1e-9)
    assert found.error == pytest.approx(64.0 * (2.0 * m) ** 2 * EPS / 1e-6, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("n", [2, 3, 5])
@pytest.mark.parametrize("m", [1, 2])
def test_an_undirected_path_has_the_spectrum_of_its_laplacian_along_itself(n, m):
    """Of μ L and a L, L with the eigenvalues 2 − 2 cos(kπ/n): on a line the margin is the least over the largest."""
    mu, a = 3.0, 0.7
    line = both_ways([(k, k + 1) for k in range(n - 1)])
    found = spectrum_of(line, n, m, mu=mu, sigma=a)
    assert found.zeros == (n - 1) * (m - 1)
    assert found.residual == 0.0
    assert 0.0 < found.margin <= 1.0
    if m > 1:
        return
    values = [2.0 - 2.0 * cos(k * pi / n) for k in range(1, n)]
    assert found.margin == pytest.approx(values[0] / values[-1], rel=1e-9)
    assert found.error == pytest.approx(64.0 * n * EPS, rel=1e-3, abs=0.0)
    roots = np.concatenate([np.roots([1.0, a * x, mu * x]) for x in values])
    assert found.slowest == pytest.approx(-roots.real.max(), rel=1e-9)


@pytest.mark.parametrize("a", [0.7, 5.0])
def test_an_undirected_pair_in_the_plane(a):
    """κ = 2μ once, γ = 2a twice, and 0 for what is left: each kernel is as large as it should be."""
    found = spectrum_of(both_ways([(0, 1)]), 2, 2, mu=3.0, sigma=a)
    assert (found.zeros, found.margin) == (1, pytest.approx(1.0, rel=1e-9))
    assert found.slowest == pytest.approx(a - sqrt(max(a * a - 6.0, 0.0)), rel=1e-9)  # of s² + 2a s + 2μ


def test_without_alignment_the_modes_that_drift_are_no_longer_simple():
    """C = 0: more is 0 than translations, and the statement is refuted."""
    found = spectrum_of(both_ways([(0, 1), (1, 2)]), 3, 1, mu=3.0, sigma=0.0)
    assert found.margin == -1.0
