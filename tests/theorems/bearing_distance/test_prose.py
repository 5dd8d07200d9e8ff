"""Errata J13 to J18, on what the bearing-distance paper says in prose: their figures, by hand and by other ways."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.environment.zone_obstacles import Box
from flockana.environment.zone_world import ZoneWorld
from flockana.interactions import ZoneRadii, ZoneWeights
from flockana.laws.bearing_distance import ZoneFlocking
from flockana.measures.metrics import min_distance
from flockana.theorems.bearing_distance.random_starts import crowd_start

RADII = ZoneRadii(1.5, c=3.0, a=5.0)


def test_j13_a_slow_agent_stops_nearer(verdict_of):
    assert verdict_of("J13").claim("letter").computed == pytest.approx(-(4.0 - 3.0) / 3.0, rel=1e-12)
    stands = verdict_of("J13").claim("stand-off")
    assert stands.computed == pytest.approx(1.5 - 3.0 * 5.0 / 12.0, abs=1e-6)
    assert verdict_of("J13").claim("reaching").computed == {0.5: 1.9375, 1.0: 2.375, 2.0: 3.25, 3.0: 4.125, 4.0: 5.0}


def test_j13_obliquely_the_longer_zone_acts_longer():
    """What its text grants: not so far off, but at a heading at which the shorter zone does not reach the wall."""
    world, heading = ZoneWorld(box=Box((0.0, 0.0), (50.0, 50.0))), np.array([[np.sin(0.8), np.cos(0.8)]])
    pushes = [
        ZoneFlocking(RADII, world=world, zone_length=name).behaviours([[47.3, 25.0]], 3.0 * heading)["obstacle"][0, 0]
        for name in ("conflict", "attraction")
    ]
    assert pushes == [0.0, pytest.approx(5.0 * (2.7 - 3.0), rel=1e-12)]


def test_j14_speeds(verdict_of):
    told, alone = (verdict_of("J14").claim(f"{name}-informed").computed for name in ("one", "none"))
    np.testing.assert_allclose(told, 3.0, rtol=1e-8)
    np.testing.assert_allclose(alone, 1.5, rtol=1e-8)
    assert np.ptp(verdict_of("J14").claim("none-of-ten").witness["mean speed by seed"]) > 0.5  # each flock its own


def test_j15_distances(verdict_of):
    assert verdict_of("J15").claim("printed").computed == pytest.approx(2.5, rel=1e-12)
    assert verdict_of("J15").claim("alone").computed == pytest.approx(3.0, rel=1e-6)
    assert max(verdict_of("J15").claim("flock").witness["least distance by seed"]) < 3.0


def test_j16_nobody_moves_and_pairs_go_straight_on(verdict_of):
    verdict = verdict_of("J16")
    assert verdict.claim("at-rest").computed == 0.0
    assert verdict.claim("fragments").computed == pytest.approx(380.0, rel=1e-12)
    growing = verdict.claim("growing").computed
    assert list(growing.values())[:2] == [pytest.approx(740.0, rel=1e-3)] * 2  # 5 m/s is less than they part by
    assert list(growing.values())[2] < 5.0


def test_j16_the_mirror_image_of_an_agent_never_meets_it():
    """Why: the box and the law are symmetric about its centre, and a lone agent keeps clear of the centre later on."""
    law = ZoneFlocking(RADII, ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0), ZoneWorld(box=Box((0, 0), (50, 50))))
    q, p = np.array([[12.0, 40.0], [38.0, 10.0]]), np.array([[2.0, 1.5], [-2.0, -1.5]])
    path = law.iterate(0.0, q, p, law.start(q, p), 3000)[0]
    np.testing.assert_allclose(path[:50, 0] + path[:50, 1], 50.0, atol=1e-12)
    assert np.linalg.norm(path[:, 1] - path[:, 0], axis=1).min() > 20.0


def test_j17_the_delay_is_the_way_between_the_radii(verdict_of):
    verdict = verdict_of("J17")
    assert verdict.claim("delay").stated == pytest.approx(3.0 / 4.5)
    near, far = verdict.claim("nearer").computed.values()
    assert far - near == pytest.approx(3.0, abs=0.3)  # by about what is seen less


def test_crowds_are_as_dense_and_apart():
    q, p = crowd_start(3, 200)
    assert q.shape == p.shape == (200, 2)
    assert min_distance(q) > 2.0
    assert 43.0 < q.max() < 10.0 * 20.0**0.5
    assert p.min() > 0.0 > crowd_start(3, 200, any_direction=True)[1].min()


def test_j18_a_large_flock_from_all_directions_falls_into_many(verdict_of):
    claim = verdict_of("J18").claim("any-direction")
    assert min(claim.witness["components by seed"]) > 1
    neighbours = verdict_of("J18").claim("local").computed
    assert neighbours[100] < neighbours[500] < 1.25 * neighbours[100]
