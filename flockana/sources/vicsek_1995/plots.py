"""Snapshots and headings over time of agents that average headings."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from flockana.base.errors import ArgumentError
from flockana.dynamics.trajectory import Trajectory
from flockana.plots.palette import INK
from flockana.plots.snapshot import configuration, draw_sample
from flockana.plots.style import line_width_and_opacity, over_time
from flockana.sources.vicsek_1995.laws import HeadingAveraging


@over_time("heading (radians)")
def headings(trajectory: Trajectory, ax: Any) -> None:
    """Draw every agent's heading over time, the angle that the law averages."""
    if "heading" not in trajectory.extra or trajectory.extra["heading"].ndim != 2:
        raise ArgumentError(f"a run of {type(trajectory.law).__name__} has no headings: expected HeadingAveraging")
    width, opacity = line_width_and_opacity(trajectory.n)
    ax.plot(trajectory.t, trajectory.extra["heading"], color=INK, linestyle="-", linewidth=width, alpha=opacity)


@draw_sample.register(HeadingAveraging)
def _draw(law: Any, trajectory: Trajectory, k: int, *, ax: Axes | None, velocities: bool, bar: bool) -> Axes:
    q, p = trajectory.q[k], trajectory.p[k] if velocities else None
    pairs = law.links(q)
    return configuration(q, p, edges=np.vstack([pairs, pairs[:, ::-1]]), ax=ax, title=f"t = {trajectory.t[k]:.4g}")
