"""Figures of a run of the dead-zone law with leaders."""

from dataclasses import replace

from flockana.dynamics.trajectory import Trajectory
from flockana.report.figures import Picture, flock_pictures
from flockana.sources.li_dead_zone.laws.with_leaders import LedDeadZoneFlocking


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw the standard figures of a run, with a caption of the snapshots that explains stars and colours."""
    first_picture, *later_pictures = flock_pictures(trajectory)
    caption = (
        "Start, middle and end. Stars are the leaders; links join agents within 1.1 d1, in contact or nearly. The "
        "player gives each agent the colour of its leader."
    )
    return (replace(first_picture, caption=caption), *later_pictures)


PICTURES = {LedDeadZoneFlocking: pictures}
