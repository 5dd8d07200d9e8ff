"""Embeddings that prove a graph planar: found where networkx finds one, checked by Euler, and never believed."""

from itertools import combinations

import networkx
import numpy as np
import pytest

from flockana.kernels.left_right import embedding
from flockana.lattice import hexagonal_patch, honeycomb, is_planar, links, planarity, square, triangular
from flockana.lattice.planarity import _embeds


def random_graph(n: int, count: int, seed: int) -> np.ndarray:
    every = np.array(list(combinations(range(n), 2)), dtype=np.int32)
    rng = np.random.default_rng([n, count, seed])
    chosen = every[rng.choice(len(every), min(count, len(every)), replace=False)]
    return rng.permuted(chosen, axis=1)


def thinned_triangulation(n: int, kept: float, seed: int) -> np.ndarray:
    """A planar graph: some links of a Delaunay triangulation, agents and links in no order."""
    from scipy.spatial import Delaunay

    rng = np.random.default_rng([n, seed])
    faces = Delaunay(rng.uniform(size=(n, 2))).simplices
    pairs = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [0, 2]]]), axis=1), axis=0)
    pairs = rng.permutation(pairs[rng.random(len(pairs)) < kept])
    return rng.permuted(rng.permutation(n)[pairs], axis=1).astype(np.int32)


def test_it_finds_an_embedding_exactly_where_networkx_does():
    answers = set()
    for seed in range(12):
        for n in (5, 6, 8, 12, 20, 40):
            for share in (0.9, 1.2, 1.5, 1.9, 2.4):
                pairs = random_graph(n, round(share * n), seed)
                planar = networkx.check_planarity(networkx.Graph(pairs.tolist()))[0]
                assert _embeds(pairs) == planar, (n, share, seed)
                answers.add((n, planar))
    assert len(answers) >= 10  # of most sizes both kinds


@pytest.mark.parametrize("kept", [1.0, 0.8, 0.5])
def test_planar_graphs_have_their_embedding_found(kept):
    for seed in range(5):
        assert _embeds(thinned_triangulation(200, kept, seed))
    assert _embeds(thinned_triangulation(4_000, kept, 0))


@pytest.mark.parametrize("q", [triangular(3000, 7.0), hexagonal_patch(31, 7.0), honeycomb(40, 40, 7.0)])
def test_large_lattices_without_networkx(q, monkeypatch):
    def refused(graph):
        raise AssertionError("networkx was asked")

    monkeypatch.setattr(networkx, "check_planarity", refused)
    monkeypatch.setattr(planarity, "_COMPILED", 9)
    assert is_planar(len(q), links(q, 8.4))


def test_one_link_too_many_is_left_to_networkx(monkeypatch):
    """A grid of squares whose opposite corners are linked is no longer planar once the middle is crossed too."""
    q = square(40, 40, 7.0)
    pairs = np.vstack([links(q, 8.4), [[0, 1599], [39, 1560]]])
    asked, judge = [], networkx.check_planarity
    monkeypatch.setattr(networkx, "check_planarity", lambda graph: asked.append(graph) or judge(graph))
    assert not is_planar(1600, pairs)
    assert len(asked) == 1
    assert is_planar(1600, pairs[:-1])
    assert len(asked) == 1


def test_an_order_that_is_none_of_a_plane_proves_nothing(monkeypatch):
    """K4 has embeddings in the plane and on the torus; a wrong order, owner or permutation must not pass."""
    four = np.array(list(combinations(range(4), 2)), dtype=np.int32)
    owner, after = embedding(4, four)
    assert _embeds(four)

    def claims(*found):
        monkeypatch.setattr(planarity, "embedding", lambda n, pairs: found)
        return _embeds(four)

    torus = after.copy()
    here = np.flatnonzero(owner == 0)
    torus[after[here]] = here  # one agent's links the other way round
    assert not claims(owner, torus)
    assert not claims(owner, np.arange(12))  # no cycle around any agent
    assert not claims(owner, np.zeros(12, dtype=int))
    swapped = owner.copy()
    swapped[[0, 1]] = swapped[[1, 0]] + 2
    assert not claims(swapped % 4, after)
    assert claims(owner, after)
