"""Perception graphs of the minimal bearing-distance model, coloured by the strain of their edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.dynamics.predicates import ensure_run
from flockana.laws.minimal import MinimalFlocking
from flockana.plots.snapshot import configuration, draw_sample, drawn_law, nearest_sample

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.dynamics.trajectory import Trajectory


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

    Raises
    ------
    ArgumentError
        If it is a run of another law, or on a time that is not of the run.
    """
    ensure_run(trajectory)
    law = drawn_law(trajectory)
    if not isinstance(law, MinimalFlocking):
        raise ArgumentError(f"law = {trajectory.law!r}: expected a run of MinimalFlocking")
    return _draw(law, trajectory, nearest_sample(trajectory.t, time), ax=ax, velocities=velocities, bar=bar)


@draw_sample.register(MinimalFlocking)
def _draw(law: Any, trajectory: Trajectory, k: int, *, ax: Axes | None, velocities: bool, bar: bool) -> Axes:
    q = trajectory.q[k]
    data = law.edge_data(q)
    return configuration(
        q,
        trajectory.p[k] if velocities else None,
        d=data.rho,
        edges=np.column_stack([data.tail, data.head]),
        ax=ax,
        bar=bar,
        title=f"t = {trajectory.t[k]:.4g}",
    )
