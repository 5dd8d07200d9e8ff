"""Scene of the player for zone-based flocking and the minimal model."""

from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.dynamics.trajectory import Trajectory
from flockana.environment.obstacles import Sphere
from flockana.player.scene import World, finite_or_none
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking


def perceived_edges(law: Any, run: Trajectory, frames: npt.NDArray[np.intp]) -> World:
    """Return what the player draws around a flock of the minimal model: the perceived edges of each frame."""
    data = [law.edge_data(run.q[k]) for k in (frames if law.edges is None else frames[:1])]
    return World(edges=tuple(np.column_stack([sample.tail, sample.head]).astype(np.int64) for sample in data))


def zone_surroundings(law: Any, run: Trajectory, frames: npt.NDArray[np.intp]) -> World:
    """Return what the player draws around a zone-based flock: obstacles, box and aliens."""
    around = law.world
    solids = tuple(obstacle for obstacle in around.obstacles if isinstance(obstacle, Sphere))
    outlines = [np.asarray(obstacle.vertices) for obstacle in around.obstacles if not isinstance(obstacle, Sphere)]
    if around.box is not None and run.m == 2:
        (x0, y0), (x1, y1) = around.box.low, around.box.high
        outlines.append(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]))
    aliens = run.extra.get("alien")
    cross_points = None if aliens is None else aliens[frames].reshape(len(frames), -1, run.m)
    reach = float(law.radii.reach[2])
    return World(reach=finite_or_none(reach), crosses=cross_points, solids=solids, outlines=tuple(outlines))


SCENE = {MinimalFlocking: perceived_edges, ZoneFlocking: zone_surroundings}
