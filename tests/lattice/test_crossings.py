"""Crossings against a brute force over all pairs of links in rational arithmetic, and every degenerate case by hand."""

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.lattice import bcc, crossings, fcc, links, separation, square, triangular
from flockana.lattice.crossings import _meet_in_space, turns_left
from tests.refused import refused


def rational_meet(a, b, c, d) -> bool:
    """Do the closed segments meet? By solving a + s(b − a) = c + t(d − c) in fractions: no orientation test."""
    u, v, w = ([y - x for x, y in zip(p, o, strict=True)] for p, o in ((a, b), (c, d), (a, c)))
    rows = [(x, -y, z) for x, y, z in zip(u, v, w, strict=True)]  # s x − t y = z
    for first, second in combinations(rows, 2):
        det = first[0] * second[1] - first[1] * second[0]
        if det:
            s = (first[2] * second[1] - first[1] * second[2]) / det
            t = (first[0] * second[2] - first[2] * second[0]) / det
            return 0 <= s <= 1 and 0 <= t <= 1 and all(x * s + y * t == z for x, y, z in rows)
    return any(on(p, x, y) for p, x, y in ((a, c, d), (b, c, d), (c, a, b), (d, a, b)))  # parallel, or a point


def on(p, a, b) -> bool:
    """Is p on the closed segment a–b?"""
    size = sum((y - x) ** 2 for x, y in zip(a, b, strict=True))
    if size == 0:
        return p == a
    s = sum((y - x) * (z - x) for x, y, z in zip(a, b, p, strict=True)) / size
    return 0 <= s <= 1 and all(x + s * (y - x) == z for x, y, z in zip(a, b, p, strict=True))


def rational_crossings(q, pairs):
    points = [[Fraction(float(v)) for v in row] for row in np.asarray(q, dtype=float)]
    found = []
    for (a, (i, j)), (b, (g, h)) in combinations(enumerate(np.asarray(pairs).tolist()), 2):
        shared = {i, j} & {g, h}
        if shared:
            s = points[shared.pop()] if len(shared) == 1 else points[i]
            one, two = (points[j if points[i] is s else i], points[h if points[g] is s else g])
            if one != s and two != s and (on(one, s, two) or on(two, s, one)):
                found.append([a, b])
        elif rational_meet(points[i], points[j], points[g], points[h]):
            found.append([a, b])
    return found


APART, OF_ONE = [[0, 1], [2, 3]], [[0, 1], [0, 2]]
SQUARE = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]

DEGENERATE = {
    "proper crossing": (SQUARE, [[0, 2], [1, 3]], True),
    "opposite sides": (SQUARE, APART, False),
    "sides at a corner": (SQUARE, [[0, 1], [1, 2]], False),
    "an agent on the middle of a link": ([[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]], APART, True),
    "an agent an ulp off a link": ([[0.0, 0.0], [2.0, 0.0], [1.0, 5e-324], [1.0, 1.0]], APART, False),
    "coincident agents": ([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0]], APART, True),
    "collinear overlap": ([[0.0, 0.0], [2.0, 2.0], [1.0, 1.0], [3.0, 3.0]], APART, True),
    "collinear, touching at coincident ends": ([[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [3.0, 3.0]], APART, True),
    "collinear, apart": ([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]], APART, False),
    "parallel": ([[0.0, 0.0], [2.0, 2.0], [0.5, 0.0], [2.5, 2.0]], APART, False),
    "of one agent, opposite ways": ([[0.0, 0.0], [1.0, 1.0], [-1.0, -1.0]], OF_ONE, False),
    "of one agent, the same way": ([[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]], OF_ONE, True),
    "of one agent, nearly the same way": ([[0.0, 0.0], [1.0, 1.0], [3.0, np.nextafter(3.0, 4)]], OF_ONE, False),
    "of one agent, at a right angle": (SQUARE, [[0, 1], [0, 3]], False),
    "the same link twice": (SQUARE, [[0, 1], [1, 0]], True),
    "a point on a link": ([[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 0.0]], APART, True),
    "a point beside a link": ([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [1.0, 1.0]], APART, False),
    "a point and its own agent's link": ([[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]], OF_ONE, False),
    "two points": ([[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]], APART, True),
    "on a line, overlapping": ([[0.0], [2.0], [1.0], [3.0]], APART, True),
    "on a line, one after the other": ([[0.0], [1.0], [2.0]], [[0, 1], [1, 2]], False),
    "on a line, one in the other": ([[0.0], [1.0], [2.0]], OF_ONE, True),
    "in space, coplanar": ([[0.0, 0, 0], [1.0, 1, 1], [1.0, 0, 0], [0.0, 1, 1]], APART, True),
    "in space, an ulp apart": ([[0.0, 0, 0], [1.0, 1, 1], [1.0, 0, 0], [0.0, 1, np.nextafter(1.0, 2)]], APART, False),
    "in space, one above the other": ([[0.0, 0, 0], [1.0, 1, 0], [1.0, 0, 1], [0.0, 1, 1]], APART, False),
    "in space, collinear overlap": ([[0.0, 0, 0], [2.0, 4, 6], [1.0, 2, 3], [3.0, 6, 9]], APART, True),
    "in space, of one agent, the same way": ([[0.0, 0, 0], [1.0, 2, 3], [3.0, 6, 9]], OF_ONE, True),
    "huge": ([[0.0, 0.0], [1e300, 1e300], [0.0, 1e300], [1e300, 0.0]], APART, True),
    "tiny": ([[0.0, 0.0], [1e-300, 1e-300], [0.0, 1e-300], [1e-300, 0.0]], APART, True),
    "tiny, of one agent, opposite ways": ([[0.0, 0.0], [1e-200, 1e-200], [-1e-200, -1e-200]], OF_ONE, False),
    "subnormal, apart": ([[0.0, 0.0], [2e-323, 1e-323], [5e-324, 5e-324], [0.0, 1e-323]], APART, False),
}


@pytest.mark.parametrize("case", DEGENERATE)
def test_degenerate_links_are_decided_as_documented(case):
    q, pairs, cross = DEGENERATE[case]
    assert crossings(q, pairs).tolist() == ([[0, 1]] if cross else [])
    assert rational_crossings(q, pairs) == ([[0, 1]] if cross else [])


def test_floating_point_alone_would_get_this_wrong():
    """An agent next to a long link, moved by single ulps: naive signs are wrong, not only zero."""
    start, end = [0.958409335179392, 0.7165132345658071], [29.805079751784863, 25.745566490890397]
    wrong = 0
    for i in range(8):
        for j in range(8):
            p = [20.958783335823433 + i * 2.0**-49, 18.07000390711034 + j * 2.0**-49]
            q, pairs = [p, [0.0, 24.0], start, end], [[0, 1], [2, 3]]
            exact = bool(rational_crossings(q, pairs))
            assert bool(len(crossings(q, pairs))) == exact
            upright = np.array(q)[:, [0, 0, 1]]  # the same in a plane of space that the first projection hides
            assert bool(len(crossings(upright, pairs))) == exact
            side = (start[0] - p[0]) * (end[1] - p[1]) - (start[1] - p[1]) * (end[0] - p[0])
            wrong += (side < 0.0 and not exact) or (side > 0.0 and exact)
    assert wrong > 0


def test_coplanar_in_space_although_floating_point_sees_a_volume():
    """Diagonals of parallelograms of large whole coordinates: their determinant is 0, its terms have 75 bits."""
    rng = np.random.default_rng(0)
    seen = 0
    for _ in range(20):
        centre, u, v = rng.integers(-(2**25), 2**25, (3, 3)).astype(float)
        q = np.array([centre - u, centre + u, centre - v, centre + v])
        assert crossings(q, [[0, 1], [2, 3]]).tolist() == [[0, 1]]
        a, b, c = q[:3] - q[3]
        minors = [b[k - 2] * c[k - 1] - b[k - 1] * c[k - 2] for k in range(3)]
        seen += a[0] * minors[0] + a[1] * minors[1] + a[2] * minors[2] != 0.0
    assert seen > 0


def configurations(m: int, coarse: bool):
    """Few agents on a coarse grid, which is full of degenerate cases, or anywhere."""
    value = st.integers(-3, 3).map(float) if coarse else st.floats(-2.0, 2.0, width=32)
    points = st.lists(st.tuples(*m * [value]), min_size=2, max_size=8)

    def linked(q):
        agent = st.integers(0, len(q) - 1)
        pairs = st.tuples(agent, agent).filter(lambda pair: pair[0] != pair[1])
        return st.tuples(st.just(q), st.lists(pairs, min_size=2, max_size=14))

    return points.flatmap(linked)


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("coarse", [True, False])
def test_all_crossings_are_those_of_rational_arithmetic(m, coarse):
    @given(configurations(m, coarse))
    def check(case):
        q, pairs = case
        assert crossings(q, pairs).tolist() == rational_crossings(q, pairs)

    check()


@pytest.mark.slow
@pytest.mark.parametrize(("m", "n"), [(1, 12), (2, 40), (3, 25)])
def test_random_nets_and_one_link_across_all_of_them(m, n):
    rng = np.random.default_rng(m)
    q = rng.uniform(0.0, 3.0 * 7.0, (n, m))
    q[0], q[1] = -200.0, 250.0
    pairs = np.concatenate([links(q, 8.4), [[0, 1]]])
    found = crossings(q, pairs)
    assert found.tolist() == rational_crossings(q, pairs)
    assert (len(found) > 20) == (m < 3)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize(("end", "crossing"), [((4, 1), False), ((0, 3), True)])
def test_in_a_plane_of_two_axes_the_projection_on_them_decides(axis, end, crossing):
    """From (3, 0) beside a diagonal, or across it: in the other projections both links lie on one line."""
    plane = [(0, 0), (4, 4), (3, 0), end]
    points = [(*place[:axis], 5, *place[axis:]) for place in plane]
    assert _meet_in_space(*points) is crossing
    assert crossings(np.array(points, dtype=float), [[0, 1], [2, 3]]).tolist() == [[0, 1]] * crossing


def test_lattices_do_not_cross_and_diagonals_do():
    q = triangular(400, 7.0)
    assert len(crossings(q, links(q, 8.4))) == 0
    q = square(20, 20, 7.0)
    assert len(crossings(q, links(q, 7.0 * 1.5))) == 19 * 19
    for q in (fcc(3, 3, 3, 7.0), bcc(3, 3, 3, 7.0)):
        assert len(crossings(q, links(q, 7.0 * 1.1))) == 0


def test_a_limit_stops_early_and_lists_that_many():
    q = square(20, 20, 7.0)
    pairs = links(q, 10.5)
    assert len(crossings(q, pairs, limit=5)) == 5
    assert len(crossings(q, pairs, limit=1000)) == 361
    every = {tuple(p) for p in crossings(q, pairs).tolist()}
    assert {tuple(p) for p in crossings(q, pairs, limit=5).tolist()} <= every


def test_all_agents_in_one_cell():
    """A collapsed flock: every two of its agents are linked, and of every four in convex position two links cross."""
    angle = 2.0 * np.pi * np.arange(30) / 30
    q = np.column_stack([np.cos(angle), np.sin(angle)])
    pairs = links(q, 8.4)
    assert len(crossings(q, pairs)) == 30 * 29 * 28 * 27 // 24


test_bad_input = refused(
    (lambda: crossings(SQUARE, [[0, 1]], limit=0), "limit = 0: expected a whole number >= 1"),
    (lambda: crossings(SQUARE, [[0, 1]], limit=True), "limit = True: expected a whole number >= 1"),
)


def test_no_links():
    assert crossings(SQUARE, []).shape == (0, 2)
    assert separation(SQUARE, [], reach=1.0).links is None


class TestSeparation:
    def test_by_hand(self):
        assert separation(SQUARE, [[0, 1], [2, 3]], reach=2.0).distance == 1.0
        assert separation(SQUARE, [[0, 1], [2, 3]], reach=0.5) == separation(SQUARE, [[0, 1]], reach=0.5)
        assert separation(SQUARE, [[0, 2], [1, 3]], reach=2.0).distance == 0.0
        assert separation(SQUARE, [[0, 1], [1, 2]], reach=2.0).links is None

    @pytest.mark.parametrize("seed", range(4))
    def test_in_space_against_sampling(self, seed):
        """The distance of two segments is convex in (s, t): a coarse grid refined twice is near its minimum."""
        rng = np.random.default_rng(seed)
        q = rng.uniform(0.0, 20.0, (14, 3))
        pairs = links(q, 9.0)
        found = separation(q, pairs, reach=20.0)
        best = np.inf
        s = np.linspace(0.0, 1.0, 201)
        for a, b in combinations(range(len(pairs)), 2):
            (i, j), (g, h) = pairs[a], pairs[b]
            if not {i, j} & {g, h}:
                one, two = (q[u] + s[:, None] * (q[v] - q[u]) for u, v in ((i, j), (g, h)))
                best = min(best, float(np.linalg.norm(one[:, None] - two[None], axis=2).min()))
        assert found.distance <= best + 1e-12
        assert found.distance == pytest.approx(best, abs=2.0 * 9.0 / 200.0)


def test_a_turn_is_decided_exactly_where_rounded_products_agree():
    """(1, 1 − e) × (1 + e, 1) = e² > 0; in floating point both products are 1."""
    e = 2.0**-30
    q = np.array([[0.0, 0.0], [1.0, 1.0 - e], [1.0 + e, 1.0]])
    assert (1.0 - e) * (1.0 + e) == 1.0
    assert turns_left(q, [0, 0, 0], [1, 2, 1], [2, 1, 1]).tolist() == [True, False, False]


def test_a_turn_is_decided_where_both_rounded_products_vanish():
    """(1, 0) × (0, 1) > 0 at any size; at 1e-200 both products are 0."""
    q = np.array([[0.0, 0.0], [1e-200, 0.0], [0.0, 1e-200]])
    assert turns_left(q, [0, 0], [1, 2], [2, 1]).tolist() == [True, False]
