"""Scene of the player for averaged headings."""

from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.dynamics.trajectory import Trajectory
from flockana.player.scene import World
from flockana.sources.vicsek_1995.laws import HeadingAveraging


def neighbour_links(law: Any, run: Trajectory, frames: npt.NDArray[np.intp]) -> World:
    """Return what the player draws for averaged headings: links between neighbours in each frame."""
    return World(edges=tuple(np.asarray(law.links(run.q[k]), dtype=np.int64) for k in frames))


SCENE = {HeadingAveraging: neighbour_links}
