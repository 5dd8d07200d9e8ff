"""Nets on graphs small enough to count by hand; errata E7 and E8."""

import numpy as np
import pytest
import sympy as sp

from flockana.measures import metrics, nets
from tests.reference import dense
from tests.refused import refused

PATH = np.array([[0.0], [1.0], [2.0]])


def net_e7():
    """Components of 1, 1, 1, 1 and 96 agents."""
    return np.concatenate([[[-400.0], [-300.0], [-200.0], [-100.0]], np.arange(96.0)[:, None]])


def test_links_are_strict_sorted_and_single():
    assert nets.links(PATH, 1.0).tolist() == []
    assert nets.links(PATH, 1.5).tolist() == [[0, 1], [1, 2]]
    assert nets.links([[0.0, 0.0]], 1.0).shape == (0, 2)
    q = np.random.default_rng(0).uniform(0.0, 60.0, (150, 2))
    assert nets.links(q, 8.4).tolist() == [list(pair) for pair in dense.links(q, 8.4)]


def test_lengths_and_components():
    pairs = nets.links(PATH * 3.0, 4.0)
    assert nets.link_lengths(PATH * 3.0, pairs).tolist() == [3.0, 3.0]
    assert nets.components(5, np.array([[0, 3], [3, 4]], dtype=np.int32)).tolist() == [0, 1, 2, 0, 0]
    assert nets.components(2, np.zeros((0, 2), dtype=np.int32)).tolist() == [0, 1]


def test_laplacian_by_hand():
    pairs = nets.links(PATH, 1.5)
    assert nets.laplacian(3, pairs).toarray().tolist() == [[1, -1, 0], [-1, 2, -1], [0, -1, 1]]
    weighted = nets.laplacian(3, pairs, np.array([0.5, 0.25])).toarray()
    assert weighted.tolist() == [[0.5, -0.5, 0.0], [-0.5, 0.75, -0.25], [0.0, -0.25, 0.25]]
    assert nets.laplacian(2, np.zeros((0, 2), dtype=np.int32)).toarray().tolist() == [[0, 0], [0, 0]]


def test_e7_share_of_edges_against_share_of_nodes():
    q = net_e7()
    assert nets.printed_edge_share(100, nets.links(q, 1.5)) == 1.0  # as printed
    assert metrics.giant_share(q, 1.5) == 0.96  # as meant
    two = np.array([[0, 1], [1, 2], [0, 2], [3, 4]], dtype=np.int32)
    assert nets.printed_edge_share(5, two) == 0.75
    assert np.isnan(nets.printed_edge_share(3, np.zeros((0, 2), dtype=np.int32)))


def test_e8_rank_of_adjacency_against_rank_of_laplacian():
    pairs = nets.links(PATH, 1.5)
    assert nets.printed_rank_connectivity(3, pairs) == pytest.approx(2 / 3, rel=1e-15)  # as printed
    assert nets.printed_rank_connectivity(3, pairs, typeset=True) == 1.0  # diag(1, 1, 0) and the path: determinant -1
    assert nets.printed_rank_connectivity(2, pairs[:0], typeset=True) == 0.5
    assert metrics.connectivity(PATH, 1.5) == 1.0  # as meant


@pytest.mark.parametrize("typeset", [False, True])
def test_ranks_of_adjacency_are_those_of_exact_elimination(typeset):
    rng = np.random.default_rng(3)
    for n in range(2, 12):
        pairs = nets.links(rng.uniform(0.0, 3.0 * np.sqrt(n), (n, 2)), 5.0)
        matrix = sp.diag(*[int(typeset)] * (n - 1), 0)
        for i, j in pairs.tolist():
            matrix[i, j] = matrix[j, i] = 1
        assert nets.printed_rank_connectivity(n, pairs, typeset=typeset) == matrix.rank() / n


def test_connectivity_is_the_rank_of_the_laplacian():
    rng = np.random.default_rng(2)
    for n in (2, 3, 7, 25):
        q = rng.uniform(0.0, 4.0 * np.sqrt(n), (n, 2))
        rank = np.linalg.matrix_rank(nets.laplacian(n, nets.links(q, 5.0)).toarray())
        assert metrics.connectivity(q, 5.0) == rank / (n - 1)


test_refusals = refused(
    (lambda: nets.printed_edge_share(3, [[0, 5]]), "links[0] = [0, 5]: expected two different agents"),
    (lambda: nets.printed_rank_connectivity(3, [[0, 5]]), "links[0] = [0, 5]: expected two different agents"),
    (lambda: nets.printed_rank_connectivity(0, []), "n = 0: expected a whole number"),
    exact=True,
)
