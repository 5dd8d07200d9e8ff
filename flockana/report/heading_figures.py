"""The figures of a run of averaged headings: snapshots, paths, and what its theorem speaks of."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from flockana import plots
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.vicsek import HeadingAveraging
from flockana.measures.windows import windows_of
from flockana.report.figures import Picture
from flockana.report.image import png

LAWS = (HeadingAveraging,)
_SETTLED = 1e-3  # of the first span of headings: until it falls below there is something to see


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw start, middle, end and paths as of any flock; headings, windows of joint connectivity, diameters.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    """
    early = trajectory.window(float(trajectory.t[0]), _until(trajectory))
    return (
        Picture(
            "Start, middle of the time until headings agree or the run ends, and end. Links join agents in or on each "
            "other's circle; arrows are velocities.",
            png(lambda figure: _snapshots(figure, early, trajectory), (13.0, 4.3)),
        ),
        Picture(
            "Paths of all agents. Headings, of which no one leaves the span of those before. C = 1 where the net is "
            "connected; grey and white bands are the shortest contiguous windows over which the nets are jointly "
            "connected, what is hatched is in none. Diameters of positions and velocities over those at the start.",
            png(lambda figure: _averaging(figure, early, trajectory), (15.0, 3.6)),
        ),
    )


def _until(run: Trajectory) -> float:
    """The time until which headings differ visibly, and the first few windows end."""
    span = run.metric("heading_spread")
    late = np.flatnonzero(span > _SETTLED * span[0])
    windows = windows_of(run)[:4]
    last = max([int(late[-1]) if late.size else 0, *(stop for _, stop in windows), 1])
    return float(run.t[min(last, len(run.t) - 1)])


def _snapshots(figure: Figure, early: Trajectory, run: Trajectory) -> None:
    times = float(run.t[0]), float(early.t[len(early.t) // 2]), float(run.t[-1])
    for ax, time in zip(figure.subplots(1, 3), times, strict=True):
        plots.snapshot(run, time, ax=ax)


def _averaging(figure: Figure, early: Trajectory, run: Trajectory) -> None:
    axes = figure.subplots(1, 4)
    plots.trajectories(run, ax=axes[0])
    plots.headings(early, ax=axes[1])
    plots.joint_windows(early, ax=axes[2])
    plots.diameters(run, ax=axes[3])
