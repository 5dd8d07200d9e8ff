"""Nets by scipy's tree, networkx and shapely; ψ_α within arb's enclosures; A by finite differences of the flow."""

import networkx as nx
import numpy as np
import pytest
import shapely
from flint import arb, ctx
from scipy.spatial import cKDTree

import flockana as fl
from flockana import AlphaInteraction, lattice
from tests.reference.values import ALPHA

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


@pytest.mark.parametrize("par", list(ALPHA))
def test_psi_alpha_lies_in_arbs_enclosures(par):
    """∫ φ_α by arb's own quadrature, which bounds its error, with the rounding that is promised: 1e-13 c*."""
    pair, before = AlphaInteraction(*par), ctx.prec
    ctx.prec = 120
    try:
        d, r, eps, h, a, b = map(arb, par)
        sigma = lambda x: ((1 + eps * x * x).sqrt() - 1) / eps  # noqa: E731
        d_alpha, r_alpha, c = sigma(d), sigma(r), abs(a - b) / (4 * a * b).sqrt()

        def phi(z, analytic):
            s = z - d_alpha + c
            return ((a + b) * s / (1 + s * s).sqrt(analytic=analytic) + a - b) / 2

        def tapered(z, analytic):
            return (1 + ((z / r_alpha - h) / (1 - h)).cos_pi()) / 2 * phi(z, analytic)

        knee = h * r_alpha
        for share in (0.0, 0.05, 0.3, 0.6, 0.77, 0.9, 0.999, 1.0):
            z = share * r_alpha
            low, high = (z, d_alpha) if z < d_alpha else (d_alpha, z)
            exact = arb(0)
            for function, start, end in (
                (phi, low.min(knee), high.min(knee)),
                (tapered, low.max(knee), high.max(knee)),
            ):
                exact += integral(function, start, end)
            exact = -exact if z < d_alpha else exact
            assert abs(arb(float(pair.psi_alpha(float(z)))) - exact) < 1e-13 * arb(pair.c_star)
    finally:
        ctx.prec = before


def integral(function, start, end):
    from flint import acb

    return acb.integral(function, acb(start), acb(end)).real


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
