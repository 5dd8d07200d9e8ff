"""The figures of a run of the dead-zone law with leaders: those of any flock, the first in its own words."""

from __future__ import annotations

from dataclasses import replace

from flockana.dynamics.trajectory import Trajectory
from flockana.laws.led_dead_zone import LedDeadZoneFlocking
from flockana.report.figures import Picture, flock_pictures

LAWS = (LedDeadZoneFlocking,)


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw what is drawn of any flock; its snapshots show who follows whom."""
    first, *others = flock_pictures(trajectory)
    caption = (
        "Start, middle and end. Stars are the leaders; links join agents within 1.1 d1, in contact or nearly. The "
        "player gives each agent the colour of its leader."
    )
    return (replace(first, caption=caption), *others)
