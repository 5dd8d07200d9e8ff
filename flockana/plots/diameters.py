"""Diameters of positions and velocities, and windows of joint connectivity."""

from typing import Any

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.measures.connectivity_windows import windows_of
from flockana.plots.palette import BLUE, FAINT, INK, VERMILLION
from flockana.plots.style import over_time, write_title

_FLOOR = 1e-12  # of the start: below it a difference is rounding


@over_time("diameter over that at the start")
def diameters(trajectory: Trajectory, ax: Any) -> None:
    """Draw the position and velocity diameters over time, each relative to its first value, on a logarithmic scale."""
    series = (("position_diameter", "positions", VERMILLION, "--"), ("velocity_diameter", "velocities", BLUE, "-"))
    for name, label, colour, dash in series:
        values = trajectory.metric(name)
        first_diameter = values[0] if values[0] > 0.0 else 1.0
        ax.plot(trajectory.t, np.maximum(values / first_diameter, _FLOOR), color=colour, linestyle=dash, label=label)
    ax.set_yscale("log")


@over_time("C, relative connectivity")
def joint_windows(trajectory: Trajectory, ax: Any) -> None:
    """Draw connectivity C over time above bands for the shortest windows that connect all agents jointly.

    Bands are grey and white in turn; what is left after the last of them is hatched.
    """
    windows, t = windows_of(trajectory), trajectory.t
    window_ends = [float(t[min(stop, len(t) - 1)]) for _, stop in windows]
    starts = [float(t[0]), *window_ends[:-1]]
    for k, (start, end) in enumerate(zip(starts, window_ends, strict=False)):
        if k % 2 == 0:
            ax.axvspan(start, end, color=FAINT, linewidth=0, zorder=0)
    last_end = window_ends[-1] if window_ends else float(t[0])
    if last_end < t[-1]:
        ax.axvspan(last_end, t[-1], facecolor="none", edgecolor=FAINT, hatch="//", linewidth=0, zorder=0)
    ax.plot(t, trajectory.metric("connectivity"), color=INK, linestyle="-", drawstyle="steps-post")
    ax.set_ylim(-0.03, 1.05)
    write_title(ax, f"{len(windows)} windows of joint connectivity", fontsize=9)
