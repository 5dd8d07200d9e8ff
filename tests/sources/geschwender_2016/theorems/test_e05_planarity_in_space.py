"""Erratum E5: nets of lattices in space that are not planar graphs."""

import sys

import networkx
import numpy as np
import pytest

from flockana.lattice import crossings, links
from flockana.measures.metrics import min_distance
from flockana.sources.geschwender_2016.theorems.e05_planarity_in_space import (
    EIGHT,
    STAR,
    fcc_eight,
    fcc_star,
    fragments,
    non_planar_fragments,
    site_links,
)

D, R = 7.0, 8.4


@pytest.fixture(scope="module")
def e5(verdict_of):
    return verdict_of("E5")


@pytest.mark.parametrize(("name", "build", "sites", "count"), [("13", fcc_star, STAR, 36), ("8", fcc_eight, EIGHT, 17)])
def test_both_counterexamples_are_lattices_with_the_links_known_beforehand(e5, name, build, sites, count):
    q = build(D)
    pairs = links(q, R)
    assert pairs.tolist() == [list(p) for p in site_links(sites)]  # floating point and whole numbers
    assert (len(q), len(pairs)) == (int(name), count)
    np.testing.assert_allclose(np.linalg.norm(q[pairs[:, 0]] - q[pairs[:, 1]], axis=1), D, rtol=1e-14)
    assert min_distance(q) == pytest.approx(D)
    assert len(crossings(q, pairs)) == 0
    assert not networkx.check_planarity(networkx.Graph(pairs.tolist()))[0]
    assert e5.claim(f"printed-{name}").status == "refuted"
    assert e5.claim(f"uncrossed-{name}").status == "verified"


def test_the_witness_is_within_the_net(e5):
    for name in ("13", "8"):
        witness = e5.claim(f"printed-{name}").witness
        net = {tuple(p) for p in links(witness["q"], R).tolist()}
        assert {tuple(p) for p in witness["links"].tolist()} <= net
        assert not networkx.check_planarity(networkx.Graph(witness["links"].tolist()))[0]
        for k in range(len(witness["links"])):  # and falls apart without any of its links
            fewer = np.delete(witness["links"], k, axis=0)
            assert networkx.check_planarity(networkx.Graph(fewer.tolist()))[0]


def test_fragments_are_enumerated_without_gaps_or_repeats():
    whole = {frozenset({(0, 0, 0)})}
    steps = [s for s in STAR if s != (0, 0, 0)]
    for size in range(2, 5):
        grown = set()
        for cluster in whole:
            for x, y, z in cluster:
                for u, v, w in steps:
                    one = cluster | {(x + u, y + v, z + w)}
                    if len(one) == size:
                        low = min(one)
                        grown.add(frozenset(tuple(a - b for a, b in zip(s, low, strict=True)) for s in one))
        whole = grown
        found = [frozenset(f) for f in fragments(size)]
        assert len(found) == len(set(found))
        assert set(found) == whole


def test_the_counter_of_non_planar_fragments_sees_them(monkeypatch):
    module = sys.modules["flockana.sources.geschwender_2016.theorems.e05_planarity_in_space"]
    monkeypatch.setattr(module, "fragments", lambda size: iter([EIGHT, EIGHT[::-1]]))
    assert non_planar_fragments(8) == (2, 2)
