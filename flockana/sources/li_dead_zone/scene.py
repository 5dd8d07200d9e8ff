"""Scene of the player for the dead-zone law with leaders."""

from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.dynamics.trajectory import Trajectory
from flockana.player.scene import World, target_paths
from flockana.sources.li_dead_zone.laws.with_leaders import LedDeadZoneFlocking


def leaders_and_groups(law: Any, run: Trajectory, frames: npt.NDArray[np.intp]) -> World:
    """Return what the player draws for the dead-zone law: leaders as stars, and a colour for each group."""
    groups = np.zeros(run.n, dtype=int)
    for number, members in enumerate(law.ties.members):
        groups[members] = number
    stars = target_paths(law.leaders, run.t[frames])
    return World(reach=1.1 * law.interaction.d1, stars=stars, groups=groups.tolist())


SCENE = {LedDeadZoneFlocking: leaders_and_groups}
