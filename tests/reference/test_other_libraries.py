"""Nets by scipy's tree, networkx and shapely; A by finite differences of the flow."""

import networkx as nx
import numpy as np
import pytest
import shapely
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


@pytest.mark.parametrize("seed", range(6))
def test_crossings_are_those_of_shapely(seed):
    q = flock(30, 2, 14.0, seed)
    pairs = fl.links(q, 8.4)
    lines = shapely.linestrings(q[pairs])
    first, second = shapely.STRtree(lines).query(lines, predicate="crosses")
    expected = sorted({(min(a, b), max(a, b)) for a, b in zip(first.tolist(), second.tolist(), strict=True)})
    assert len(expected) > 10
    assert sorted(tuple(sorted(pair)) for pair in lattice.crossings(q, pairs).tolist()) == expected


Q = lattice.hexagonal_spiral(5, 7.0) + np.random.default_rng(1).uniform(-0.5, 0.5, (5, 2))
LAWS = {
    "free": fl.Algorithm1(),
    "led": fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))),
    "by a wall": fl.Algorithm3(
        target=fl.StaticTarget((0.0, 0.0)), obstacles=[fl.Wall((0.0, Q[:, 1].min() - 3.0), (0.0, 1.0))]
    ),
    "dead zone": fl.DeadZoneFlocking(),
}


@pytest.mark.parametrize("name", sorted(LAWS))
def test_a_linearisation_is_the_difference_of_the_flow(name):
    """A by central differences of (p, u), of fourth order: every entry to 1e-6 of the largest."""
    law, size, step = LAWS[name], Q.size, 1e-4

    def flow(x):
        places, speeds = x[:size].reshape(Q.shape), x[size:].reshape(Q.shape)
        return np.concatenate([x[size:], law.acceleration(0.0, places, speeds).ravel()])

    rest, columns = np.concatenate([Q.ravel(), np.zeros(size)]), []
    for k in range(2 * size):
        unit = np.zeros(2 * size)
        unit[k] = step
        near, far = flow(rest + unit) - flow(rest - unit), flow(rest + 2 * unit) - flow(rest - 2 * unit)
        columns.append((8.0 * near - far) / (12.0 * step))
    found = fl.linearise(law, Q, allow_residual=True).A
    np.testing.assert_allclose(np.transpose(columns), found, rtol=0.0, atol=1e-6 * np.abs(found).max())
