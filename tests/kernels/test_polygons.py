"""Points and ways against polygons: by hand, and against shapely where they touch, overlap and cross."""

from math import sqrt

import numpy as np
import pytest
import shapely

from flockana.kernels.polygons import from_boundary, ways_from_boundary
from flockana.kernels.segments import UNSURE

ARROW = np.array([(0.0, 0.0), (4.0, 2.0), (0.0, 4.0), (2.0, 2.0)])  # concave on the left
ROUNDING = 1e-14  # some roundings of numbers below 10


def edges_of(corners):
    return np.hstack([corners, np.roll(corners, -1, axis=0)])


def polygon(rng, digits):
    """A star-shaped polygon either way round, its corners rounded; None where its boundary meets itself."""
    angle, radius = np.sort(rng.uniform(0.0, 2.0 * np.pi, 7)), rng.uniform(0.3, 3.0, 7)
    corners = np.round(2.0 + np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), digits)
    return corners[:: rng.choice([-1, 1])] if shapely.Polygon(corners).is_valid else None


def ways_about(rng, corners, digits):
    """Ways in the plane, and some that begin on an edge, lead from corner to corner, touch one or have no length."""
    start = rng.uniform(-3.0, 7.0, (400, 2))
    end = start + rng.normal(0.0, rng.choice([0.1, 3.0]), (400, 2))
    edges = edges_of(corners)[rng.integers(len(corners), size=50)]
    start[:50] = edges[:, :2] + rng.uniform(0.0, 1.0, (50, 1)) * (edges[:, 2:] - edges[:, :2])
    end[50:100] = 2.0 * edges[:, :2] - start[50:100]
    start[100:150], end[100:150] = edges[:, :2], edges[::-1, :2]
    end[150:200] = start[150:200]
    return np.round(start, digits), np.round(end, digits)


@pytest.fixture(params=[0, 1, 15], ids=lambda digits: f"{digits} digits", scope="module")
def cases(request):
    rng = np.random.default_rng(request.param)
    corners = [found for _ in range(60) if (found := polygon(rng, request.param)) is not None]
    assert len(corners) > 20
    return [(each, *ways_about(rng, each, request.param)) for each in corners]


def told(corners, q):
    distance, inside = from_boundary(q, edges_of(corners))
    return np.where(inside == 1, -distance, distance), inside


def test_points_are_as_far_as_shapely_says_and_on_the_side_where_it_is_sure(cases):
    unsure = 0
    for corners, q, _ in cases:
        shape, points = shapely.Polygon(corners), shapely.points(q)
        distance, inside = from_boundary(q, edges_of(corners))
        np.testing.assert_allclose(distance, shapely.distance(points, shape.boundary), rtol=0.0, atol=ROUNDING)
        sure = (inside != UNSURE) & (distance > 0.0)
        np.testing.assert_array_equal(inside[sure] == 1, shapely.contains(shape, points)[sure])
        assert not inside[distance == 0.0].any()
        assert distance[~sure].max(initial=0.0) < ROUNDING
        unsure += np.count_nonzero(inside == UNSURE)
    assert unsure < 0.05 * 400 * len(cases)


def test_ways_are_as_far_as_shapely_says_and_meet_where_it_is_sure(cases):
    met_sure, met_not = 0, 0
    for corners, start, end in cases:
        shape, ways = shapely.Polygon(corners), shapely.linestrings(np.stack([start, end], axis=1))
        (at_start, first), (at_end, last) = told(corners, start), told(corners, end)
        known = (first != UNSURE) & (last != UNSURE)
        distance, met = ways_from_boundary(start, end, at_start, at_end, edges_of(corners))
        np.testing.assert_allclose(distance, shapely.distance(ways, shape.boundary), rtol=0.0, atol=ROUNDING)
        sure = (met != UNSURE) & known
        np.testing.assert_array_equal(met[sure] == 1, shapely.intersects(ways, shape)[sure])
        met_sure, met_not = met_sure + np.count_nonzero(met[sure]), met_not + np.count_nonzero(met[sure] == 0)
        assert distance[met == UNSURE].max(initial=0.0) < ROUNDING
    assert min(met_sure, met_not) > 50 * len(cases)  # of 400 ways


def test_points_by_hand():
    q = np.array([[0.0, 2.0], [5.0, 2.0], [3.0, 2.0], [0.0, -3.0], [4.0, 2.0], [2.0, 1.0], [1.0, 2.0]])
    for corners in (ARROW, ARROW[::-1]):
        distance, inside = from_boundary(q, edges_of(corners))
        expected = [sqrt(2.0), 1.0, sqrt(0.2), 3.0, 0.0, 0.0, sqrt(0.5)]
        np.testing.assert_allclose(distance, expected, rtol=1e-15, atol=0.0)
        assert inside.tolist() == [0, 0, 1, 0, 0, 0, 0]


def test_a_point_within_rounding_of_an_edge_is_unsure():
    thirds = np.array([(0.0, 0.0), (1.0, 1.0 / 3.0), (0.0, 1.0)])
    _, inside = from_boundary(np.array([[0.3, 0.1], [0.3, 0.1 + 1e-9], [0.3, 0.1 - 1e-9]]), edges_of(thirds))
    assert inside.tolist() == [UNSURE, 1, 0]


@pytest.mark.parametrize(
    ("start", "end", "distance", "met"),
    [
        ((0.0, 1.0), (0.0, 3.0), sqrt(0.5), 0),  # past the notch, nearest at its ends
        ((5.0, 0.0), (5.0, 9.0), 1.0, 0),  # past a corner, between its ends
        ((5.0, 2.0), (5.0, 2.0), 1.0, 0),  # no way at all
        ((3.0, 2.0), (3.0, 2.0), sqrt(0.2), 1),
        ((3.0, 2.0), (3.2, 2.0), 0.8 / sqrt(5.0), 1),  # within it
        ((4.0, 1.0), (4.0, 3.0), 0.0, 1),  # touches a corner
        ((-1.0, 2.0), (9.0, 2.0), 0.0, 1),  # through notch and tip
        ((1.0, -1.0), (1.0, 9.0), 0.0, 1),  # through both arms, with both ends outside
    ],
)
def test_ways_by_hand(start, end, distance, met):
    a, b = np.array([start]), np.array([end])
    found, meets = ways_from_boundary(a, b, told(ARROW, a)[0], told(ARROW, b)[0], edges_of(ARROW))
    assert found[0] == pytest.approx(distance, rel=1e-14)
    assert meets[0] == met
