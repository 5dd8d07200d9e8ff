"""The proofs of Theorem 5: a smaller constant, a wrong weight or a false embedding makes a step fail."""

import re
from fractions import Fraction
from itertools import combinations
from math import sqrt

import numpy as np
import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import sympy as sp
import z3

from flockana.lattice import crossings, hexagonal_spiral, links
from flockana.sources.geschwender_2016.theorems import e05_planarity_in_space as e5
from flockana.theorems import verify
from proofs import nonplanar_fcc, theorem5_counts, theorem5_crossings
from proofs.proof import names

K5 = tuple(combinations(range(5), 2))
K33 = tuple((i, j) for i in range(3) for j in range(3, 6))


def subdivided(graph, link, new):
    return [*(pair for pair in graph if pair != link), (link[0], new), (new, link[1])]


def test_all_fragments_of_six_sites_are_planar():
    graphs = {nonplanar_fcc.links_of(sites) for sites in nonplanar_fcc.grown(nonplanar_fcc.shapes(5))}
    assert all(nonplanar_fcc.embeds(6, links) for links in graphs)
    assert len(graphs) > 500


def test_a_smaller_constant_has_a_crossing_that_refutes_it():
    step = theorem5_crossings.short_side("some side is at most 0.7 of the longer link", z3.Q(49, 100))
    assert step.holds is False
    found = {name: Fraction(value) for name, value in re.findall(r"(\w) = (-?\d+(?:/\d+)?)", step.evidence)}
    a, b, c, e, k = (found[name] for name in "abcek")
    assert a + b <= 1
    assert c + e <= 1
    x = np.array([float(k), sqrt(1 - float(k) ** 2)])  # the found crossing, drawn
    q = np.array([[-float(a), 0.0], [float(b), 0.0], -float(c) * x, float(e) * x])
    assert crossings(q, [[0, 1], [2, 3]]).tolist() == [[0, 1]]
    assert min(np.linalg.norm(q[i] - q[j]) for i in (0, 1) for j in (2, 3)) > 0.7


def test_the_extension_needs_its_constant_too():
    assert [step.holds for step in theorem5_crossings.every_net(z3.Q(1, 2))] == [True, True]
    assert [step.holds for step in theorem5_crossings.every_net(z3.Q(49, 100))] == [False, True]
    assert [step.holds for step in theorem5_crossings.every_net(z3.Q(24, 100))] == [False, False]


def test_a_sign_in_the_law_of_cosines_breaks_both_identities(monkeypatch):
    assert theorem5_crossings.cosine_mean() == (0, 0)
    right = theorem5_crossings.squared_sides

    def wrong(a, b, c, e, k):
        return a**2 + c**2, *right(a, b, c, e, k)[1:]

    monkeypatch.setattr(theorem5_crossings, "squared_sides", wrong)
    assert theorem5_crossings.cosine_mean()[0] != 0


def test_the_planar_bound_is_no_better_than_it_is():
    assert theorem5_counts.planar("3n - 6", 6).holds is True
    refuted = theorem5_counts.planar("3n - 7", 7)
    assert refuted.holds is False
    assert "met by" in refuted.evidence


def test_cayley_menger_of_regular_simplices():
    # (-1)^(m+1) 2^m (m!)² V² for m + 1 points: V = 1, √3/4 and √2/12 for edges of 1
    volumes = {2: sp.S.One, 3: sp.sqrt(3) / 4, 4: sp.sqrt(2) / 12}
    for points, volume in volumes.items():
        m = points - 1
        value = theorem5_counts.cayley_menger(points).subs(sp.Symbol("d", positive=True), 1)
        assert value == (-1) ** points * 2**m * sp.factorial(m) ** 2 * volume**2


def test_the_spiral_is_the_librarys_and_another_order_has_fewer_links(monkeypatch):
    for n in (1, 7, 8, 20, 37):
        sites = theorem5_counts.spiral(n)
        assert len(set(sites)) == n
        assert theorem5_counts.squared_distances(sites).count(1) == len(links(hexagonal_spiral(n, 7.0), 8.4))
    monkeypatch.setattr(theorem5_counts, "spiral", lambda n: tuple((x, 0) for x in range(n)))
    failed = [step.text for step in theorem5_counts.PROOF.steps() if not step.holds]
    assert any("they have ⌊3n - √(12n - 3)⌋ links" in text for text in failed)


def test_the_sites_are_those_of_the_erratum():
    assert set(nonplanar_fcc.STAR) == set(e5.STAR)
    assert set(nonplanar_fcc.EIGHT) == set(e5.EIGHT)
    assert len(nonplanar_fcc.links_of(nonplanar_fcc.EIGHT)) == 17


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([(0, 0, 0), (2, 2, 0), (2, 0, 0), (0, 2, 0)], True),  # diagonals
        ([(0, 0, 0), (2, 0, 0), (1, 0, 0), (1, 3, 0)], True),  # an end on the other
        ([(0, 0, 0), (2, 0, 0), (2, 1, 0), (2, 3, 0)], False),  # beside its end
        ([(0, 0, 0), (2, 2, 0), (2, 0, 1), (0, 2, 1)], False),  # skew
        ([(0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0)], False),  # parallel
        ([(0, 0, 0), (3, 0, 0), (4, 0, 0), (2, 0, 0)], True),  # overlapping on a line
        ([(0, 0, 0), (3, 0, 0), (4, 0, 0), (5, 0, 0)], False),  # apart on a line
        ([(0, 0, 0), (3, 0, 0), (-2, 0, 0), (-1, 0, 0)], False),  # on the other side
        ([(0, 0, 0), (2, 0, 0), (1, 1, 1), (3, 5, 7)], False),
    ],
)
def test_segments_meet_in_whole_numbers(points, expected):
    assert nonplanar_fcc.meet(*points) is expected
    a, b, c, d = points
    assert nonplanar_fcc.meet(d, c, a, b) is expected
    assert len(crossings(np.array(points, dtype=float), [[0, 1], [2, 3]])) == expected


def test_overlaps_of_links_with_a_common_agent():
    assert nonplanar_fcc.overlap((0, 0, 0), (1, 1, 0), (3, 3, 0))
    assert not nonplanar_fcc.overlap((0, 0, 0), (1, 1, 0), (-1, -1, 0))
    assert not nonplanar_fcc.overlap((0, 0, 0), (1, 1, 0), (1, 0, 1))
    sites = ((0, 0, 0), (2, 2, 0), (1, 1, 0), (1, 1, 2))
    assert nonplanar_fcc.crossing(sites, ((0, 1), (0, 2), (2, 3))) == 2  # 02 on 01, and 2 on 01


def test_a_subdivision_is_recognised_and_nothing_else_is():
    assert nonplanar_fcc.is_subdivided("K5", K5)
    assert nonplanar_fcc.is_subdivided("K5", subdivided(subdivided(K5, (0, 1), 5), (5, 1), 6))
    assert nonplanar_fcc.is_subdivided("K3,3", subdivided(K33, (0, 3), 6))
    assert not nonplanar_fcc.is_subdivided("K5", [*K5, (0, 5), (5, 1)])  # a link and a path in parallel
    assert not nonplanar_fcc.is_subdivided("K5", tuple(combinations(range(4), 2)))
    assert not nonplanar_fcc.is_subdivided("K3,3", K5)
    assert not nonplanar_fcc.is_subdivided("K5", K33)
    assert not nonplanar_fcc.is_subdivided("K5", K5[1:])
    assert not nonplanar_fcc.is_subdivided("K3,3", [*K33, (0, 1)])
    prism = [(0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5), (0, 3), (1, 4), (2, 5)]  # nine links, six corners, planar
    assert not nonplanar_fcc.is_subdivided("K3,3", prism)
    assert not nonplanar_fcc.is_subdivided("K3,3", [(0, 1), (1, 2), (2, 0)])


def test_an_embedding_is_counted_not_believed(monkeypatch):
    import networkx

    K4 = tuple(combinations(range(4), 2))
    assert nonplanar_fcc.embeds(4, K4)
    assert not nonplanar_fcc.embeds(6, (*K4, (4, 5)))  # planar, but in two parts: the count is of connected graphs
    assert not nonplanar_fcc.embeds(5, K5)

    class Torus:
        def __init__(self, rings):
            self.rings = rings

        def get_data(self):
            return self.rings

    claimed = {i: [j for j in range(5) if j != i] for i in range(5)}
    monkeypatch.setattr(networkx, "check_planarity", lambda graph: (True, Torus(claimed)))
    assert not nonplanar_fcc.embeds(5, K5)
    around = {i: [j for j in range(4) if j != i] for i in range(4)}  # K4 on a torus: two faces
    monkeypatch.setattr(networkx, "check_planarity", lambda graph: (True, Torus(around)))
    assert not nonplanar_fcc.embeds(4, K4)
    monkeypatch.setattr(networkx, "check_planarity", lambda graph: (True, Torus({0: [1], 1: [0]})))
    assert not nonplanar_fcc.embeds(4, K4)  # other links than asked


def test_shapes_are_counted_by_growing():
    assert [len(nonplanar_fcc.shapes(size)) for size in (1, 2, 3, 4, 5)] == [1, 1, 4, 20, 131]


@pytest.mark.parametrize(
    ("theorem", "expected"),
    [("E5", {"nonplanar-fcc"}), ("E6", {"theorem5-counts"}), ("os-5", {"theorem5-crossings", "theorem5-counts", None})],
)
def test_claims_name_their_proofs(theorem, expected):
    case = {"q": hexagonal_spiral(7, 7.0), "d": 7.0, "r": 8.4} if theorem == "os-5" else {}
    claims = verify(theorem, **case).claims
    assert {claim.proof or claim.disproof for claim in claims} == expected
    assert expected - {None} <= set(names())
    if case:  # cited, and true of the plane only
        assert [claim.name for claim in claims if claim.proof is None] == ["i-graph", "ii-sharp"]
