"""Perception graphs of the minimal bearing-distance model, coloured by the strain of their edges."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from flockana.base.errors import ArgumentError
from flockana.dynamics.trajectory import Trajectory
from flockana.plots.snapshot import configuration, draw_sample, drawn_law, snapshot
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking


def perception(
    trajectory: Trajectory,
    time: float | None = None,
    *,
    ax: Axes | None = None,
    velocities: bool = False,
    bar: bool = True,
) -> Axes:
    """Draw the sample nearest to a time with its perception graph, as `snapshot` and films do.

    An edge leads from the agent that is perceived to the one that perceives it, as information does; it has an
    arrowhead if it goes one way only.

    Parameters
    ----------
    time : float, optional
        By default the end.
    bar : bool
        Draw the colour bar of (length − ρ)/ρ.
    """
    if not isinstance(drawn_law(trajectory), MinimalFlocking):
        raise ArgumentError(f"law = {trajectory.law!r}: expected a run of MinimalFlocking")
    return snapshot(trajectory, time, ax=ax, velocities=velocities, bar=bar)


@draw_sample.register(MinimalFlocking)
def _draw(law: Any, trajectory: Trajectory, k: int, *, ax: Axes | None, velocities: bool, bar: bool) -> Axes:
    q, p = trajectory.q[k], trajectory.p[k] if velocities else None
    data, title = law.edge_data(q), f"t = {trajectory.t[k]:.4g}"
    return configuration(q, p, d=data.rho, edges=np.column_stack([data.tail, data.head]), ax=ax, bar=bar, title=title)
