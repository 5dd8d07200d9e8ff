"""Erratum J13: an altitude that grows with speed, where its force begins and where an agent stops."""

import numpy as np
import pytest

from flockana import Box, ZoneFlocking, ZoneRadii, ZoneWorld

RADII = ZoneRadii(1.5, c=3.0, a=5.0)


def test_a_slow_agent_stops_nearer(verdict_of):
    assert verdict_of("J13").claim("letter").computed == pytest.approx(-(4.0 - 3.0) / 3.0, rel=1e-12)
    stands = verdict_of("J13").claim("stand-off")
    assert stands.computed == pytest.approx(1.5 - 3.0 * 5.0 / 12.0, abs=1e-6)
    assert verdict_of("J13").claim("reaching").computed == {0.5: 1.9375, 1.0: 2.375, 2.0: 3.25, 3.0: 4.125, 4.0: 5.0}


def test_obliquely_the_longer_zone_acts_longer():
    world, heading = ZoneWorld(box=Box((0.0, 0.0), (50.0, 50.0))), np.array([[np.sin(0.8), np.cos(0.8)]])
    pushes = [
        ZoneFlocking(RADII, world=world, zone_length=name).behaviours([[47.3, 25.0]], 3.0 * heading)["obstacle"][0, 0]
        for name in ("conflict", "attraction")
    ]
    assert pushes == [0.0, pytest.approx(5.0 * (2.7 - 3.0), rel=1e-12)]
