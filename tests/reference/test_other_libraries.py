"""Nets by scipy's tree, networkx and shapely."""

import networkx as nx
import numpy as np
import pytest
from scipy.spatial import cKDTree

import flockana as fl
from flockana import lattice

FLOCKS = [(1, 2, 10.0), (40, 1, 60.0), (60, 2, 25.0), (200, 2, 60.0), (80, 3, 20.0)]


def flock(n, m, size, seed=0):
    return np.random.default_rng(seed + n).uniform(-size, size, (n, m))


@pytest.mark.parametrize(("n", "m", "size"), FLOCKS)
def test_links_are_those_of_a_tree_and_components_those_of_networkx(n, m, size):
    q, r = flock(n, m, size), 8.4
    found = fl.links(q, r)
    expected = cKDTree(q).query_pairs(r, output_type="ndarray")
    assert {tuple(sorted(pair)) for pair in found.tolist()} == {tuple(sorted(pair)) for pair in expected.tolist()}
    net = nx.empty_graph(n)
    net.add_edges_from(found.tolist())
    parts = list(nx.connected_components(net))
    labels = fl.components(n, found)
    assert {frozenset(np.flatnonzero(labels == k).tolist()) for k in set(labels.tolist())} == set(map(frozenset, parts))
    assert fl.giant_share(q, r) == max(map(len, parts)) / n
    weights = np.random.default_rng(n).uniform(0.1, 2.0, len(found))
    for (i, j), weight in zip(found.tolist(), weights, strict=True):
        net[i][j]["weight"] = weight
    np.testing.assert_allclose(
        np.asarray(fl.laplacian(n, found, weights).todense()),
        nx.laplacian_matrix(net).toarray(),
        rtol=1e-14,
        atol=1e-14,
    )
    assert lattice.coordination(n, found).tolist() == [degree for _, degree in net.degree()]
    assert lattice.is_planar(n, found) == nx.check_planarity(net)[0]
