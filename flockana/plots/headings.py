"""Snapshots and headings over time of agents that average headings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.dynamics.predicates import ensure_run
from flockana.laws.vicsek import HeadingAveraging
from flockana.plots.snapshot import configuration, draw_sample
from flockana.plots.style import INK, ensure_axes, finish_over_time, line_width_and_opacity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.dynamics.trajectory import Trajectory


def headings(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw every agent's heading over time, the angle that the law averages.

    Raises
    ------
    ArgumentError
        If the run remembers no headings.
    """
    ensure_run(trajectory)
    if "heading" not in trajectory.extra or trajectory.extra["heading"].ndim != 2:
        raise ArgumentError(f"a run of {type(trajectory.law).__name__} has no headings: expected HeadingAveraging")
    axes: Any = ensure_axes(ax)
    width, opacity = line_width_and_opacity(trajectory.n)
    axes.plot(trajectory.t, trajectory.extra["heading"], color=INK, linestyle="-", linewidth=width, alpha=opacity)
    return finish_over_time(axes, trajectory.t, "heading (radians)")


@draw_sample.register(HeadingAveraging)
def _draw(law: Any, trajectory: Trajectory, k: int, *, ax: Axes | None, velocities: bool, bar: bool) -> Axes:
    q = trajectory.q[k]
    pairs = law.links(q)
    return configuration(
        q,
        trajectory.p[k] if velocities else None,
        edges=np.vstack([pairs, pairs[:, ::-1]]),
        ax=ax,
        title=f"t = {trajectory.t[k]:.4g}",
    )
