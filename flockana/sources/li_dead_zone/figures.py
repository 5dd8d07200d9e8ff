"""Figures of a run of the dead-zone law with leaders."""

from dataclasses import replace

from flockana.dynamics.trajectory import Trajectory
from flockana.report.figures import Picture, flock_pictures
from flockana.sources.li_dead_zone.laws.with_leaders import LedDeadZoneFlocking


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw the figures of any flock; captions of snapshots name the followers of each leader."""
    first_picture, *later_pictures = flock_pictures(trajectory)
    caption = (
        "Start, middle and end. Stars are the leaders; links join agents within 1.1 d1, in contact or nearly. The "
        "player gives each agent the colour of its leader."
    )
    return (replace(first_picture, caption=caption), *later_pictures)


PICTURES = {LedDeadZoneFlocking: pictures}
