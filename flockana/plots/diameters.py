"""Diameters of positions and velocities, and windows of joint connectivity."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.dynamics.predicates import ensure_run
from flockana.measures.windows import windows_of
from flockana.plots.style import BLUE, FAINT, INK, VERMILLION, ensure_axes, finish_over_time, write_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.dynamics.trajectory import Trajectory

_FLOOR = 1e-12  # of the start: below it a difference is rounding


def diameters(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the position and velocity diameters over time, each relative to its first value.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Where to draw; its scale becomes logarithmic.
    """
    ensure_run(trajectory)
    axes: Any = ensure_axes(ax)
    series = (("position_diameter", "positions", VERMILLION, "--"), ("velocity_diameter", "velocities", BLUE, "-"))
    for name, label, colour, dash in series:
        values = trajectory.metric(name)
        first = values[0] if values[0] > 0.0 else 1.0
        axes.plot(trajectory.t, np.maximum(values / first, _FLOOR), color=colour, linestyle=dash, label=label)
    axes.set_yscale("log")
    return finish_over_time(axes, trajectory.t, "diameter over that at the start")


def joint_windows(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw C over time above bands for the shortest contiguous windows that connect all agents jointly.

    Bands are grey and white in turn; what is left after the last of them is hatched.

    Parameters
    ----------
    trajectory : Trajectory
        A run of a law with a range.

    Raises
    ------
    ArgumentError
        If the law has no net.
    """
    ensure_run(trajectory)
    windows = windows_of(trajectory)
    axes: Any = ensure_axes(ax)
    t = trajectory.t
    ends = [float(t[min(stop, len(t) - 1)]) for _, stop in windows]
    starts = [float(t[0]), *ends[:-1]]
    for k, (start, end) in enumerate(zip(starts, ends, strict=False)):
        if k % 2 == 0:
            axes.axvspan(start, end, color=FAINT, linewidth=0, zorder=0)
    rest = ends[-1] if ends else float(t[0])
    if rest < t[-1]:
        axes.axvspan(rest, t[-1], facecolor="none", edgecolor=FAINT, hatch="//", linewidth=0, zorder=0)
    axes.plot(t, trajectory.metric("connectivity"), color=INK, linestyle="-", drawstyle="steps-post")
    axes.set_ylim(-0.03, 1.05)
    write_title(axes, f"{len(windows)} windows of joint connectivity", fontsize=9)
    return finish_over_time(axes, t, "C, relative connectivity")
