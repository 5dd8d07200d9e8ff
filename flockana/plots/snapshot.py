"""One instant of a flock: agents, velocities, links coloured by strain, the γ-agent, obstacles with β-agents."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from mpl_toolkits.mplot3d.art3d import Line3DCollection  # type: ignore[import-untyped]

from flockana.checks import FloatArray, ensure_finite_scalar, ensure_points
from flockana.environment.beta import ObstacleField
from flockana.environment.obstacles import Obstacle
from flockana.interactions import BetaInteraction
from flockana.nets import link_lengths, links
from flockana.plots.obstacles import bounds
from flockana.plots.obstacles import obstacles as draw_obstacles
from flockana.plots.style import GREEN, INK, MUTED, PURPLE, STRAIN, VERMILLION, ensure_axes, frame_space

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.trajectory import Trajectory

_ARROW = 0.07  # longest arrow as a share of the axes' width
_AT_REST = 1e-9  # speed, relative to the size of the flock per unit of time, below which no arrow is drawn


def snapshot(
    trajectory: Trajectory,
    time: float | None = None,
    *,
    ax: Axes | None = None,
    velocities: bool = True,
    bar: bool = True,
) -> Axes:
    """Draw the sample of a run nearest to a time, with its links if the law has an interaction range.

    Obstacles are drawn, and the β-agents on them, where the law has any.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    time : float, optional
        By default the end.
    ax : matplotlib.axes.Axes, optional
        Where to draw; three-dimensional for m = 3.
    velocities : bool
        Draw arrows.
    bar : bool
        Draw the colour bar of the strain.

    Returns
    -------
    matplotlib.axes.Axes
    """
    when = trajectory.t[-1] if time is None else ensure_finite_scalar("time", time)
    k = int(np.argmin(np.abs(trajectory.t - when)))
    pair_law, target = getattr(trajectory.law, "alpha", None), getattr(trajectory.law, "target", None)
    q, t = trajectory.q[k], float(trajectory.t[k])
    return configuration(
        q,
        trajectory.p[k] if velocities else None,
        d=getattr(pair_law, "d", None),
        r=getattr(pair_law, "r", None),
        target=None if target is None else target.position(t),
        obstacles=getattr(trajectory.law, "obstacles", ()),
        beta=getattr(trajectory.law, "beta", None),
        ax=ax,
        bar=bar,
        title=f"t = {t:.4g}",
    )


def configuration(
    q: Any,
    p: Any = None,
    *,
    d: float | None = None,
    r: float | None = None,
    target: Any = None,
    obstacles: Sequence[Obstacle] = (),
    beta: BetaInteraction | None = None,
    ax: Axes | None = None,
    bar: bool = True,
    title: str = "",
) -> Axes:
    """Draw agents, and what else is given: velocities as arrows, links within r coloured by (length − d)/d, a γ-agent,
    obstacles, and the β-agents on them that are within r' of their agent, each joined to it by a dotted line.

    Parameters
    ----------
    q : array_like, shape (n, m)
        Positions, m = 1, 2 or 3.
    p : array_like, shape (n, m), optional
        Velocities; without them agents are dots.
    d : float, optional
        Desired distance; without it links are grey.
    r : float, optional
        Interaction range; without it no links are drawn.
    target : array_like, shape (m,), optional
        Position of the γ-agent.
    obstacles : sequence of Obstacle
        Drawn in full, and kept in view where they are bounded.
    beta : BetaInteraction, optional
        Its r' says which β-agents to draw; without it there are none.
    ax : matplotlib.axes.Axes, optional
        Where to draw; three-dimensional for m = 3.
    bar : bool
        Draw the colour bar of the strain.
    title : str
        Of the axes.

    Returns
    -------
    matplotlib.axes.Axes
    """
    points = ensure_points("q", q)
    m = points.shape[1]
    axes: Any = ensure_axes(ax, m=m)
    x = _in_plane(points)
    if r is not None and len(points) > 1:
        _links(axes, x, points, d, r, bar)
    size = float(np.clip(900.0 / len(x), 3.0, 26.0))
    axes.scatter(*x.T, s=size, color=INK, linewidths=0, zorder=3, label="agents")
    seen = x
    if target is not None:
        mark = _in_plane(np.asarray(target, dtype=np.float64)[None, :])
        axes.scatter(
            *mark.T, s=110, marker="*", color=VERMILLION, edgecolors="white", linewidths=0.6, zorder=4, label="γ-agent"
        )
        seen = np.vstack([x, mark])
    if len(obstacles):
        seen = np.vstack([seen, _in_plane(bounds(obstacles))])
        draw_obstacles(obstacles, ax=axes, view=seen[:, :m])
        if beta is not None:
            _beta_agents(axes, points, ObstacleField(tuple(obstacles), beta), size)
    fastest = _arrows(axes, x, p)
    axes.set_title(title + (f"   longest arrow: {fastest:.3g} length/time" if fastest else ""), fontsize=9)
    _frame(axes, seen, m)
    return axes  # type: ignore[no-any-return]  # the stubs have no three-dimensional axes


def _in_plane(points: FloatArray) -> FloatArray:
    """Agents on a line are drawn on the axis y = 0."""
    return np.column_stack([points, np.zeros(len(points))]) if points.shape[1] == 1 else points


def _links(ax: Any, x: FloatArray, points: FloatArray, d: float | None, r: float, bar: bool) -> None:
    pairs = links(points, r)
    segments = x[pairs]
    kind: Any = Line3DCollection if x.shape[1] == 3 else LineCollection
    width = float(np.clip(120.0 / len(points), 0.7, 1.8))
    if d is None:
        ax.add_collection(kind(segments, colors=MUTED, linewidths=width, zorder=2))
        return
    strain, limit = (link_lengths(points, pairs) - d) / d, r / d - 1.0
    lines = kind(segments, cmap=STRAIN, norm=Normalize(-limit, limit), linewidths=width, zorder=2)
    lines.set_array(strain)
    ax.add_collection(lines)
    if bar:
        label, pad = "strain (length − d)/d", 0.12 if x.shape[1] == 3 else 0.03
        scale = ax.get_figure().colorbar(lines, ax=ax, extend="min", shrink=0.75, aspect=28, pad=pad, label=label)
        scale.outline.set_visible(False)


def _beta_agents(ax: Any, points: FloatArray, field: ObstacleField, size: float) -> None:
    """Draw the β-agents in range, each joined to its agent."""
    near = field.links(points, np.zeros_like(points))
    if near.agent.size == 0:
        return
    ends = np.stack([_in_plane(points[near.agent]), _in_plane(near.q)], axis=1)
    kind: Any = Line3DCollection if ends.shape[2] == 3 else LineCollection
    ax.add_collection(kind(ends, colors=PURPLE, linewidths=0.9, linestyles=":", zorder=2))
    look = {"facecolors": "white", "edgecolors": PURPLE, "linewidths": 0.8, "zorder": 3}
    ax.scatter(*ends[:, 1].T, s=0.7 * size, marker="D", label="β-agents", **look)


def _arrows(ax: Any, x: FloatArray, p: Any) -> float:
    """Draw velocities; return the largest speed drawn, 0 if none is worth an arrow."""
    if p is None:
        return 0.0
    v = _in_plane(ensure_points("p", p))
    fastest = float(np.linalg.norm(v, axis=1).max())
    extent = float(np.ptp(x, axis=0).max()) or 1.0
    if fastest <= _AT_REST * extent:
        return 0.0
    if x.shape[1] == 3:
        ax.quiver(*x.T, *v.T, length=_ARROW * extent / fastest, color=GREEN, linewidth=0.6, arrow_length_ratio=0.25)
    else:
        ax.quiver(
            *x.T, *v.T, angles="xy", scale_units="width", scale=fastest / _ARROW, width=0.0022, color=GREEN, zorder=2.5
        )
    return fastest


def _frame(ax: Any, points: FloatArray, m: int) -> None:
    """Equal axes with units; a line has no y."""
    if m > 1:
        frame_space(ax, points)
        return
    ax.set_xlabel("x (length)")
    ax.set_yticks([])
    ax.set_ylim(-1.0, 1.0)
    ax.margins(x=0.05)
