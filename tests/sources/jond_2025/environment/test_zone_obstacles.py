"""Obstacle zones, polygons, balls and boxes against shapely, and what each reading of the paper does."""

from math import sqrt

import numpy as np
import pytest
import shapely

from flockana import Alien, Polygon, SimplePolygon, Sphere, ZoneFlocking, ZoneRadii, ZoneWeights, ZoneWorld
from flockana.base.errors import ArgumentError
from flockana.sources.jond_2025.environment.zone_obstacles import Box, ball_clearance_along
from tests.refused import refused

C, BASE = 3.0, 0.5
RADII = ZoneRadii(1.5, c=C, a=5.0)
UNIT = ZoneWeights(obstacle=1.0)
ARROW = SimplePolygon([(0.0, 0.0), (4.0, 2.0), (0.0, 4.0), (2.0, 2.0)])


def force(world, q, heading, **options):
    """The obstacle behaviour of one agent with unit weight."""
    law = ZoneFlocking(RADII, UNIT, world, **options)
    q, p = np.atleast_2d(q).astype(float), np.atleast_2d(heading).astype(float)
    return law.behaviours(q, p)["obstacle"][0]


def triangle(q, heading, depth=C):
    h = np.array(heading) / np.linalg.norm(heading)
    aside = BASE * C * np.array([h[1], -h[0]])
    return shapely.Polygon([q + depth * h, q + aside, q - aside])


def random_polygon(rng):
    """A star-shaped polygon, concave as often as not."""
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, 7))
    radius = rng.uniform(0.3, 3.0, 7)
    return rng.uniform(0.0, 4.0, 2) + np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


@pytest.mark.slow
@pytest.mark.parametrize("depth", ["conflict", "attraction"])
def test_trigger_and_force_against_shapely(depth):
    rng, met = np.random.default_rng(1), 0
    for _ in range(300):
        corners = random_polygon(rng)
        if not shapely.Polygon(corners).is_valid:
            continue
        q, heading = rng.uniform(-3.0, 7.0, 2), rng.normal(size=2)
        shape, point = shapely.Polygon(corners), shapely.Point(q)
        zone = triangle(q, heading, C if depth == "conflict" else 5.0)
        wanted = np.zeros(2)
        if zone.intersects(shape):
            met += 1
            distance = shape.exterior.distance(point)
            foot = shape.exterior.interpolate(shape.exterior.project(point))
            b = (np.array([foot.x, foot.y]) - q) / distance
            wanted = (distance + C if shape.contains(point) else min(0.0, distance - C)) * b
        found = force(ZoneWorld((SimplePolygon(corners),)), q, heading, zone_length=depth)
        np.testing.assert_allclose(found, wanted, atol=1e-7)  # shapely's projection is good to that
    assert 50 < met < 250


def test_a_polygon_inside_the_zone_is_met_and_the_printed_test_misses_it():
    small = ZoneWorld((SimplePolygon([(1.0, 0.3), (1.2, 0.3), (1.1, 0.5)]),))
    assert force(small, (0.0, 0.0), (1.0, 0.0)).any()
    assert not force(small, (0.0, 0.0), (1.0, 0.0), trigger="three-segments").any()


def test_the_printed_test_misses_a_corner_between_its_segments():
    corner = ZoneWorld((SimplePolygon([(1.0, 0.5), (9.0, 9.0), (-1.0, 9.0)]),))
    assert force(corner, (0.0, 0.0), (1.0, 0.0)).any()
    assert not force(corner, (0.0, 0.0), (1.0, 0.0), trigger="three-segments").any()
    ahead = ZoneWorld((SimplePolygon([(2.0, -1.0), (4.0, -1.0), (4.0, 1.0), (2.0, 1.0)]),))
    for trigger in ("exact", "three-segments"):
        np.testing.assert_allclose(force(ahead, (0.0, 0.0), (5.0, 0.0), trigger=trigger), [-1.0, 0.0])


def test_zones_look_ahead_only():
    behind = ZoneWorld((SimplePolygon([(-1.0, -1.0), (-0.5, -1.0), (-0.5, 1.0), (-1.0, 1.0)]),))
    assert not force(behind, (0.0, 0.0), (1.0, 0.0)).any()
    assert force(behind, (0.0, 0.0), (-1.0, 0.0)).any()
    assert not force(behind, (0.0, 0.0), (0.0, 0.0)).any(), "an agent that never moved has no heading"


def test_inside_an_obstacle_the_letter_pushes_deeper():
    block = ZoneWorld((Polygon([(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)]),))  # a simple one too
    q, heading = (1.0, 4.0), (-1.0, 0.0)  # the boundary is 1 to the left
    np.testing.assert_allclose(force(block, q, heading), [-4.0, 0.0])
    np.testing.assert_allclose(force(block, q, heading, inside="literal", trigger="three-segments"), [2.0, 0.0])
    np.testing.assert_allclose(force(block, q, (1.0, 0.0)), [-4.0, 0.0])  # whatever the heading


def test_a_long_zone_attracts_by_the_letter():
    far = ZoneWorld((SimplePolygon([(4.0, -1.0), (9.0, -1.0), (9.0, 1.0), (4.0, 1.0)]),))
    assert not force(far, (0.0, 0.0), (1.0, 0.0), zone_length="attraction").any()
    letter = force(far, (0.0, 0.0), (1.0, 0.0), zone_length="attraction", obstacle_force="literal")
    np.testing.assert_allclose(letter, [1.0, 0.0])


@pytest.mark.parametrize("m", [2, 3])
@pytest.mark.parametrize("trigger", ["exact", "three-segments"])
def test_balls_are_met_by_triangles_and_by_cones_alike(m, trigger):
    rng, met = np.random.default_rng(2), 0
    for _ in range(200):
        q, h = rng.uniform(-2.0, 2.0, 2), rng.normal(size=2)
        centre, radius = rng.uniform(-4.0, 4.0, 2), rng.uniform(0.2, 1.5)
        point, zone = shapely.Point(centre), triangle(q, h)
        if np.linalg.norm(centre - q) < radius:
            continue
        if trigger == "three-segments":
            tips = zone.exterior.coords[:3]
            hit = min(shapely.LineString([q, tip]).distance(point) for tip in tips) <= radius
        else:
            hit = zone.distance(point) <= radius
        met += hit
        apart = np.linalg.norm(centre - q)
        wanted = min(0.0, apart - radius - C) * (centre - q) / apart if hit else np.zeros(2)
        lift = [0.0] * (m - 2)  # the plane through the axis of the cone
        found = force(ZoneWorld((Sphere((*centre, *lift), radius),)), [*q, *lift], [*h, *lift], trigger=trigger)
        np.testing.assert_allclose(found, [*wanted, *lift], atol=1e-12)
    assert 20 < met < 150


def test_inside_a_ball_the_push_is_outwards():
    found = force(ZoneWorld((Sphere((0.0, 0.0, 0.0), 2.0),)), (1.5, 0.0, 0.0), (0.0, 0.0, 1.0))
    np.testing.assert_allclose(found, [0.5 + C, 0.0, 0.0])


@pytest.mark.parametrize("m", [2, 3])
def test_walls_are_met_by_the_corners_of_the_zone(m):
    box, rng = Box((0.0,) * m, (20.0,) * m), np.random.default_rng(3)
    for _ in range(100):
        q, h = rng.uniform(0.5, 19.5, m), rng.normal(size=m)
        h /= np.linalg.norm(h)
        rim = []  # of the base, all round
        for side in np.linalg.svd(h[None])[2][1:] if m == 2 else []:
            rim += [q + BASE * C * side, q - BASE * C * side]
        if m == 3:
            one, two = np.linalg.svd(h[None])[2][1:]
            rim = [q + BASE * C * (np.cos(a) * one + np.sin(a) * two) for a in np.linspace(0.0, 2.0 * np.pi, 2001)]
        reach = np.array([q + C * h, *rim])
        wanted = np.zeros(m)
        for k in range(m):
            wanted[k] += (C - q[k]) if reach[:, k].min() < 0.0 else 0.0
            wanted[k] -= (C - (20.0 - q[k])) if reach[:, k].max() > 20.0 else 0.0
        found = force(ZoneWorld(box=box), q, h)
        if abs(reach.min()) > 1e-4 and abs(reach.max() - 20.0) > 1e-4:  # the rim is sampled
            np.testing.assert_allclose(found, wanted, atol=1e-12)


def test_beyond_a_wall_and_in_a_corner():
    box = ZoneWorld(box=Box((0.0, 0.0), (20.0, 20.0)))
    np.testing.assert_allclose(force(box, (-0.5, 9.0), (0.0, 1.0)), [3.5, 0.0])
    np.testing.assert_allclose(force(box, (-0.5, 9.0), (0.0, 1.0), inside="literal"), [-2.5, 0.0])
    np.testing.assert_allclose(force(box, (1.0, 0.5), (-1.0, -1.0)), [2.0, 2.5])
    np.testing.assert_allclose(force(box, (1.0, 0.5), (-1.0, -1.0), walls="nearest"), [0.0, 2.5])


def test_the_buffer_repels_whatever_the_heading():
    square = ZoneWorld(
        (SimplePolygon([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]),), Box((-9.0, -9.0), (9.0, 9.0))
    )
    away = force(square, (1.0, 4.0), (0.0, 1.0), obstacle_zone="buffer")
    np.testing.assert_allclose(away, [0.0, C - (3.0 - sqrt(2.0))], atol=1e-15)  # the circle of radius √2
    assert not force(square, (1.0, 4.0), (0.0, 1.0)).any()
    wall = force(square, (-7.0, -5.0), (1.0, 0.0), obstacle_zone="buffer")
    np.testing.assert_allclose(wall, [1.0, 0.0])


def test_clearances_against_shapely():
    rng, shape = np.random.default_rng(4), shapely.Polygon(ARROW.vertices)
    q = rng.uniform(-2.0, 6.0, (200, 2))
    wanted = [shape.exterior.distance(shapely.Point(x)) * (-1 if shape.contains(shapely.Point(x)) else 1) for x in q]
    np.testing.assert_allclose(ARROW.clearance(q), wanted, rtol=1e-12, atol=1e-14)
    start, end = q[:100], q[100:]
    bound = ARROW.clearance_along(start, end)
    np.testing.assert_array_equal(bound, ARROW.clearance_along(start, end, tuple(map(ARROW.clearance, (start, end)))))
    for a, b, least in zip(start, end, bound, strict=True):
        way = shapely.LineString([a, b])
        if way.intersects(shape):
            inner = ARROW.clearance(a + np.linspace(0.0, 1.0, 101)[:, None] * (b - a))
            assert least <= inner.min()
            assert least <= 0.0
        else:
            assert least == pytest.approx(way.distance(shape), rel=1e-12)


def test_a_world_is_as_clear_as_the_nearest_of_its_obstacles_at_each_sample_and_on_each_way():
    rng, ball = np.random.default_rng(6), Sphere((5.0, 5.0), 0.5)
    world, q, taken = ZoneWorld((ARROW, ball)), rng.uniform(-1.0, 6.0, (30, 4, 2)), np.arange(0, 29, 3)
    at, on_way = world.clearances(q, taken)
    assert (at.shape, on_way.shape) == ((30, 4), (10, 4))
    for k in range(30):
        np.testing.assert_array_equal(at[k], np.minimum(ARROW.clearance(q[k]), ball.clearance(q[k])))
    for row, k in zip(on_way, taken, strict=True):
        ways = q[k], q[k + 1]
        np.testing.assert_array_equal(row, np.minimum(ARROW.clearance_along(*ways), ball_clearance_along(ball, *ways)))


def test_the_bound_of_a_way_through_a_ball_is_exact():
    ball = Sphere((0.0, 0.0), 2.0)
    found = ball_clearance_along(ball, np.array([[-5.0, 1.0], [3.0, 0.0]]), np.array([[5.0, 1.0], [3.0, 0.0]]))
    np.testing.assert_allclose(found, [-1.0, 1.0])


def test_the_smallest_disc():
    disc = SimplePolygon([(0.0, 0.0), (6.0, 0.0), (6.0, 1.0), (0.0, 1.0)]).enclosing_circle()
    np.testing.assert_allclose([*disc.centre, disc.radius], [3.0, 0.5, sqrt(9.25)], rtol=1e-12)


test_polygons_that_are_none = refused(
    (lambda: SimplePolygon([(0, 0), (1, 1)]), r"vertices have shape \(2, 2\): expected \(V, 2\) with V >= 3"),
    (lambda: SimplePolygon([(0, 0, 0), (1, 0, 0), (0, 1, 0)]), "expected .V, 2."),
    (lambda: SimplePolygon([(0, 0), (2, 2), (2, 0), (0, 2)]), r"does not meet itself.*Self-intersection.1 1."),
    (lambda: SimplePolygon([(0, 0), (1, 0), (2, 0)]), "encloses an area"),
    (lambda: ARROW.clearance([[0.0, 0.0, 0.0]]), r"q has shape \(1, 3\): expected \(N, 2\), points of the plane"),
)


test_worlds_that_cannot_be = refused(
    (lambda: Box((0.0, 5.0), (9.0, 5.0)), "expected low < high on every axis"),
    (lambda: Alien((9.0, 9.0), ARROW), r"start = \(9.0, 9.0\): expected a point of the alien's territory"),
    (lambda: Alien((9.0, 9.0, 1.0), ARROW), "expected a SimplePolygon, and an alien in the plane"),
    (lambda: Alien((9.0, 9.0), detection=0), "detection = 0: expected a number > 0"),
    (lambda: ZoneWorld((ARROW,), Box((0.0,) * 3, (9.0,) * 3)), "of one dimension"),
    (lambda: ZoneWorld(ARROW), "expected a sequence of SimplePolygon or Sphere"),
    (lambda: ZoneWorld(box=(0.0, 50.0)), "expected a Box"),
)


def test_starts_that_cannot_be():
    world = ZoneWorld((ARROW, Sphere((9.0, 9.0), 1.0)), Box((-1.0, -1.0), (12.0, 12.0)), (Alien((6.0, 6.0)),))
    world.check_start(np.array([[5.0, 5.0], [-1.0, -1.0]]))
    for bad, message in (
        ((13.0, 0.0), r"q\[1\] = \[13.  0.\]: expected a point of Box"),
        ((3.0, 2.0), "expected a point outside obstacle 0"),
        ((9.0, 9.5), "expected a point outside obstacle 1"),
        ((6.0, 6.0), r"q\[1\] is where alien 0 begins"),
    ):
        with pytest.raises(ArgumentError, match=message):
            world.check_start(np.array([[5.0, 5.0], bad]))


def test_a_polygon_holds_its_boundary_and_what_is_within():
    triangle = SimplePolygon([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)])
    points = np.array([(1.0, 1.0), (0.0, 0.0), (2.0, 2.0), (3.0, 3.0), (-1e-9, 1.0)])
    assert (triangle.clearance(points) <= 0.0).tolist() == [True, True, True, False, False]
