"""Planarity with its witness, link bounds, completeness."""

from itertools import combinations

import networkx
import numpy as np
import pytest

from flockana.lattice import fcc, is_complete, is_planar, kuratowski, links, planar_bound, square

K5 = list(combinations(range(5), 2))
K33 = [(i, j) for i in range(3) for j in range(3, 6)]
PETERSEN = [
    *((i, (i + 1) % 5) for i in range(5)),
    *((i, i + 5) for i in range(5)),
    *((i + 5, (i + 2) % 5 + 5) for i in range(5)),
]
CUBE = [(i, i ^ bit) for i in range(8) for bit in (1, 2, 4) if i < i ^ bit]


def smoothed(pairs) -> networkx.Graph:
    """The graph without its agents of degree 2, each replaced by a link of its two neighbours."""
    graph = networkx.Graph(np.asarray(pairs).tolist())
    for agent in [v for v, k in graph.degree if k == 2]:
        i, j = graph.neighbors(agent)
        assert not graph.has_edge(i, j)
        graph.remove_node(agent)
        graph.add_edge(i, j)
    return graph


@pytest.mark.parametrize(
    ("n", "pairs", "planar"),
    [(5, K5, False), (6, K33, False), (10, PETERSEN, False), (8, CUBE, True), (4, K5[:3], True), (5, K5[1:], True)],
)
def test_known_graphs(n, pairs, planar):
    assert is_planar(n, pairs) == planar
    assert (kuratowski(n, pairs) is None) == planar


@pytest.mark.parametrize(
    ("n", "pairs"),
    [
        (5, K5),
        (6, K33),
        (10, PETERSEN),
        (32, links(fcc(2, 2, 2, 7.0), 8.4)),
        (36, links(square(6, 6, 7.0), 10.5)),
        (7, [*K5, (4, 5), (5, 6)]),
        (6, [(0, 5), (5, 1), *K5[1:]]),
    ],
)
def test_the_witness_is_a_subdivision_within_the_graph(n, pairs):
    found = kuratowski(n, pairs)
    given = {frozenset(map(int, p)) for p in pairs}
    assert {frozenset(p) for p in found.links.tolist()} <= given
    graph = smoothed(found.links)
    assert set(graph.nodes) == set(found.corners)
    if found.kind == "K5":
        assert networkx.is_isomorphic(graph, networkx.complete_graph(5))
    else:
        assert set(map(frozenset, graph.edges)) == {
            frozenset((i, j)) for i in found.corners[:3] for j in found.corners[3:]
        }


def test_bounds():
    assert [planar_bound(n) for n in range(1, 7)] == [0, 1, 3, 6, 9, 12]
    triangulation = [(i, j) for i, j in combinations(range(6), 2) if j != i + 3]  # the octahedron
    assert len(triangulation) == planar_bound(6)
    assert is_planar(6, triangulation)
    assert not is_planar(6, [*triangulation, (0, 3)])


def test_completeness_counts_pairs_once():
    assert is_complete(5, K5)
    assert not is_complete(5, K5[1:])
    assert not is_complete(5, [*K5[1:], (2, 1)])  # ten links, of which two are one
    assert is_complete(1, [])
    assert not is_complete(3, [(0, 1), (1, 0), (1, 2)])
