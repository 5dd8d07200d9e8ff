"""Paths in space: of every agent, and of the centre of mass against the γ-agent."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from flockana.base.value_checks import FloatArray
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.plots.palette import BLUE, INK, MUTED, VERMILLION
from flockana.plots.style import ensure_axes, finish, frame_space, limit, line_width_and_opacity, lines, star
from flockana.plots.symbol_typesetting import typeset

_STILL = 1e-6  # of the flock's extent: a centre that moves by less stands still


def trajectories(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw every agent's path with its end, and the γ-agent's; on a line, positions over time."""
    ensure_run(trajectory)
    axes = ensure_axes(ax, m=trajectory.m)
    paths = np.stack([_plane(trajectory.t, trajectory.q[:, i]) for i in range(trajectory.n)])
    width, alpha = line_width_and_opacity(trajectory.n)
    axes.add_collection(lines(list(paths), colors=BLUE, linewidths=width, alpha=alpha))
    axes.scatter(*paths[:, 0].T, s=7, facecolors="none", edgecolors=MUTED, linewidths=0.6, label="start", zorder=3)
    axes.scatter(*paths[:, -1].T, s=7, color=INK, linewidths=0, label="end", zorder=3)
    target = _target(axes, trajectory)
    _frame(axes, np.vstack([paths.reshape(-1, paths.shape[2]), *target]), trajectory.m)
    return finish(axes)


def centre_path(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the path of the centre of mass against the γ-agent's; on a line, both over time."""
    ensure_run(trajectory)
    axes = ensure_axes(ax, m=trajectory.m)
    centre = _plane(trajectory.t, trajectory.q.mean(axis=1))
    axes.plot(*centre.T, color=BLUE, linestyle="-", linewidth=1.8, label="centre of mass")
    axes.scatter(*centre[:1].T, s=28, facecolors="white", edgecolors=BLUE, zorder=3)
    axes.scatter(*centre[-1:].T, s=28, color=BLUE, zorder=3)
    target = _target(axes, trajectory)
    _frame(axes, np.vstack([centre, *target]), trajectory.m)
    _widen(axes, np.vstack([centre, *target]), trajectory)
    return finish(axes)


def _widen(ax: Any, points: FloatArray, trajectory: Trajectory) -> None:
    """Widen the view if a path is constant up to rounding."""
    extent = float(np.ptp(trajectory.q.reshape(-1, trajectory.m), axis=0).max())
    if trajectory.m > 1 and float(np.ptp(points, axis=0).max()) < _STILL * extent:
        if trajectory.m == 2:
            ax.set_aspect("equal", adjustable="box")  # else the limits below are for matplotlib to change
        limit(ax, points[0] - 0.5 * extent, points[0] + 0.5 * extent)


def _plane(t: FloatArray, x: FloatArray) -> FloatArray:
    """Return the points of a path to draw: (t, x) for motion on a line, else the positions."""
    return np.column_stack([t, x]) if x.shape[1] == 1 else x


def _target(ax: Any, trajectory: Trajectory) -> tuple[FloatArray, ...]:
    """Draw the γ-agent's path and return it in a tuple; empty without a γ-agent."""
    target = trajectory.law.target
    if target is None:
        return ()
    path = _plane(trajectory.t, np.array([target.position(t) for t in trajectory.t.tolist()]))
    ax.plot(*path.T, color=VERMILLION, linestyle="--", linewidth=1.4, label="γ-agent", zorder=4)
    star(ax, path[-1:], s=90, zorder=5)
    return (path,)


def _frame(ax: Any, points: FloatArray, m: int) -> None:
    if m == 1:
        ax.set(xlabel=typeset("t (time)"), ylabel=typeset("x (length)"))
    else:
        frame_space(ax, points, m)
