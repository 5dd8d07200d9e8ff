"""Snapshots of a flock: agents, velocities, links coloured by strain, the γ-agent, obstacles.

A law with a world of its own registers how it is drawn (`draw_sample`) and what a film of it must show (`in_view`);
snapshots, films and the report then show it so. Of a map that steps another law, that law is drawn.
"""

from collections.abc import Sequence
from functools import singledispatch
from itertools import combinations
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.colors import Normalize

from flockana.base import value_checks
from flockana.base.errors import ArgumentError
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import Obstacle, ObstacleField
from flockana.interactions import BetaInteraction
from flockana.measures.nets import components, link_lengths, links
from flockana.plots.obstacles import bounds
from flockana.plots.obstacles import obstacles as draw_obstacles
from flockana.plots.palette import GREEN, INK, MUTED, PURPLE, STRAIN, VERMILLION
from flockana.plots.style import colour_bar, ensure_axes, frame_space, in_plane, lines, star, write_title

_ARROW = 0.07  # longest arrow as a share of the axes' width
_MANY = 4.0  # links per agent beyond which they are drawn thinner; a lattice has 3
_AT_REST = 1e-4  # share of the law's own speed below which a run is drawn without arrows: velocities are rounding
_ROUNDING = 1e-9  # share of a run's duration by which a time that was computed may miss its ends
_COINCIDE = 1e-4  # share of the size of the flock below which agents are drawn as one


def snapshot(
    trajectory: Trajectory,
    time: float | None = None,
    *,
    ax: Axes | None = None,
    velocities: bool = True,
    bar: bool = True,
    ranges: bool = False,
) -> Axes:
    """Draw the sample of a run nearest to a time, with links if the law has a range.

    Obstacles are drawn, and the β-agents on them, where the law has any; so is the world of a zone-based law.

    Parameters
    ----------
    time : float, optional
        By default the end.
    bar : bool
        Draw the colour bar of the strain.
    ranges : bool
        Draw a circle about each agent at the distance within which it interacts, in the plane.
    """
    ensure_run(trajectory)
    k = nearest_sample(trajectory.t, time)
    law = drawn_law(trajectory)
    moving = float(np.linalg.norm(trajectory.p[k], axis=1).max()) > _AT_REST * trajectory.scales.speed
    axes_drawn = draw_sample(law, trajectory, k, ax=ax, velocities=velocities and moving, bar=bar)
    if ranges:
        _range_circles(axes_drawn, trajectory.q[k], law)
    return axes_drawn


def nearest_sample(t: value_checks.FloatArray, time: float | None) -> int:
    """Return the index of the sample nearest to a time; the last by default."""
    if time is None:
        return len(t) - 1
    given_time, first_time, last_time = value_checks.ensure_finite_scalar("time", time), float(t[0]), float(t[-1])
    time_tolerance = _ROUNDING * (last_time - first_time)
    if not first_time - time_tolerance <= given_time <= last_time + time_tolerance:
        raise ArgumentError(f"time = {given_time:g}: expected a time of the run, {first_time:g} to {last_time:g}")
    return int(np.argmin(np.abs(t - given_time)))


def _range_circles(ax: Any, q: value_checks.FloatArray, law: Any) -> None:
    """Draw circles at the range of the pair law, or of each agent."""
    if law.pair is None or not np.isfinite(law.pair.range) or q.shape[1] != 2:
        raise ArgumentError(
            f"ranges = True: expected a law with a range in the plane, not {law!r} for m = {q.shape[1]}"
        )
    ranges = getattr(law, "ranges", None)
    widths = np.broadcast_to(2.0 * np.asarray(law.pair.range if ranges is None else ranges), len(q))
    plot_style: dict[str, Any] = {"facecolor": "none", "edgecolor": MUTED, "linewidth": 0.5, "alpha": 0.6}
    plot_style |= {"units": "xy", "offsets": q, "offset_transform": ax.transData}
    ax.add_collection(EllipseCollection(widths, widths, np.zeros(len(q)), **plot_style))


def drawn_law(trajectory: Trajectory) -> Any:
    """Return the drawn law of a run: for a map, the law behind it."""
    ensure_run(trajectory)
    return trajectory.law.continuous or trajectory.law


@singledispatch
def draw_sample(law: Any, trajectory: Trajectory, k: int, *, ax: Axes | None, velocities: bool, bar: bool) -> Axes:
    """Draw sample k of a run; laws register their own drawings with ``@draw_sample.register(Law)``."""
    pair, target = law.pair, law.target
    t = float(trajectory.t[k])
    return configuration(
        trajectory.q[k],
        trajectory.p[k] if velocities else None,
        d=None if pair is None else pair.length,
        r=None if pair is None else pair.range,
        target=None if target is None else target.position(t),
        obstacles=law.obstacles,
        beta=None if law.obstacle_field is None else law.obstacle_field.beta,
        ax=ax,
        bar=bar,
        title=f"t = {t:.4g}",
    )


@singledispatch
def in_view(law: Any, trajectory: Trajectory) -> value_checks.FloatArray:
    """Return points that must be visible in a film of a run, shape (N, m)."""
    corners = [trajectory.q.reshape(-1, trajectory.m)]
    if law.target is not None:
        corners.append(np.array([law.target.position(t) for t in trajectory.t.tolist()]))
    if law.obstacles:
        corners.append(bounds(law.obstacles))
    return np.concatenate(corners)


def configuration(
    q: Any,
    p: Any = None,
    *,
    d: Any = None,
    r: float | None = None,
    edges: Any = None,
    target: Any = None,
    obstacles: Sequence[Obstacle] = (),
    beta: BetaInteraction | None = None,
    ax: Axes | None = None,
    bar: bool = True,
    title: str = "",
) -> Axes:
    """Draw agents with velocities, links, γ-agent and obstacles, where given.

    Links within r are coloured by (length − d)/d; β-agents within r' are joined to their agents by dotted lines.

    Parameters
    ----------
    p : array_like, shape (n, m), optional
        Velocities; without them agents are dots.
    d : float or array_like, shape (M,), optional
        Desired distance, or that of each of the `edges`; without it links are grey.
    r : float, optional
        Interaction range; without it (and without `edges`) no links are drawn.
    edges : array_like of int, shape (M, 2), optional
        Links to draw in place of those within r, from the first agent to the second; one without its reverse has an
        arrowhead.
    obstacles : sequence of Obstacle
        Drawn in full, and kept in view where they are bounded.
    beta : BetaInteraction, optional
        Its r' says which β-agents to draw; without it there are none.
    bar : bool
        Draw the colour bar of the strain.
    """
    points = value_checks.ensure_points("q", q)
    m = points.shape[1]
    pairs = None if edges is None else value_checks.ensure_links(edges, len(points), "edges")
    d = None if d is None else _lengths(d, pairs)
    axes = ensure_axes(ax, m=m)
    x = in_plane(points)
    if pairs is not None:
        _links(axes, x, points, pairs, d, None, bar)
        _arrowheads(axes, x, pairs)
    elif r is not None and len(points) > 1:
        _links(axes, x, points, links(points, r), d, r, bar)
    marker_size = float(np.clip(900.0 / len(x), 3.0, 26.0))
    axes.scatter(*x.T, s=marker_size, color=INK, linewidths=0, zorder=3, label="agents")
    _multiplicities(axes, x)
    corners = x
    if target is not None:
        position = in_plane(np.asarray(target, dtype=np.float64)[None, :])
        star(axes, position, label="γ-agent")
        corners = np.vstack([x, position])
    if len(obstacles):
        corners = np.vstack([corners, in_plane(bounds(obstacles))])
        draw_obstacles(obstacles, ax=axes, view=corners[:, :m])
        if beta is not None:
            _beta_agents(axes, points, ObstacleField(tuple(obstacles), beta), marker_size)
    write_title(axes, title + ("" if p is None else velocity_arrows(axes, points, p)), fontsize=9)
    return frame_space(axes, corners, m)


def _lengths(d: Any, pairs: Any) -> Any:
    """Return desired distances: one number > 0, or one for each edge."""
    if pairs is None or np.isscalar(d):
        return value_checks.ensure_positive("d", d)
    desired = value_checks.ensure_series("d", d, len(pairs))
    if not (desired > 0.0).all():
        raise ArgumentError(f"d has the entry {desired.min():g}: expected numbers > 0")
    return desired


def _multiplicities(ax: Any, x: value_checks.FloatArray) -> None:
    """Write ×k beside each position shared by k agents."""
    extent = float(np.ptp(x, axis=0).max())
    near = links(x, _COINCIDE * extent) if extent else np.array(list(combinations(range(len(x)), 2)))
    if len(near) == 0:
        return
    groups, plot_style = components(len(x), near), {"fontsize": 7, "color": VERMILLION, "ha": "left", "va": "bottom"}
    for group in np.unique(groups[near]):
        in_group = groups == group
        ax.text(*x[in_group].mean(axis=0), f"  ×{in_group.sum()}", zorder=5, **plot_style)


def _links(
    ax: Any, x: value_checks.FloatArray, points: value_checks.FloatArray, pairs: Any, d: Any, r: float | None, bar: bool
) -> None:
    """Draw links coloured by strain; the scale ends at the breaking strain, at most 1."""
    # Where agents have many, links are thin, and those near d lie above the others.
    if len(pairs) == 0:
        return
    few = min(1.0, (_MANY * len(points) / max(1, len(pairs))) ** 0.5)
    plot_style: dict[str, Any] = {"linewidths": few * float(np.clip(120.0 / len(points), 0.7, 1.8)), "zorder": 2}
    if d is None:
        ax.add_collection(lines(x[pairs], colors=MUTED, **plot_style))
        return
    strain = (link_lengths(points, pairs) - d) / d
    order = np.argsort(-np.abs(strain), kind="stable") if few < 1.0 else slice(None)
    limit = 1.0 if r is None else min(1.0, r / d - 1.0)
    coloured = lines(x[pairs[order]], array=strain[order], cmap=STRAIN, norm=Normalize(-limit, limit), **plot_style)
    ax.add_collection(coloured)
    if bar:
        colour_bar(ax, coloured, "strain (length − d)/d", extend="min" if limit < 1.0 else "max")


def _arrowheads(ax: Any, x: value_checks.FloatArray, pairs: Any) -> None:
    """Mark one-way links with arrowheads at their midpoints."""
    pair_set = {tuple(pair) for pair in pairs.tolist()}
    one_way = np.array([pair for pair in pairs.tolist() if (pair[1], pair[0]) not in pair_set], dtype=np.int64)
    if one_way.size == 0 or x.shape[1] == 3:
        return
    start, end = x[one_way[:, 0]], x[one_way[:, 1]]
    direction = (end - start) / np.maximum(np.linalg.norm(end - start, axis=1, keepdims=True), np.finfo(float).tiny)
    look = {"angles": "xy", "scale_units": "inches", "scale": 9.0, "units": "inches", "width": 0.02, "pivot": "middle"}
    head_sizes = {"headwidth": 6.0, "headlength": 5.5, "headaxislength": 5.5, "minlength": 0.0}
    ax.quiver(*(0.45 * start + 0.55 * end).T, *direction.T, color=MUTED, zorder=2.2, **look, **head_sizes)


def _beta_agents(ax: Any, points: value_checks.FloatArray, field: ObstacleField, size: float) -> None:
    """Draw the β-agents in range, each joined to its agent."""
    near_links = field.links(points, np.zeros_like(points))
    if near_links.agent.size == 0:
        return
    segment_ends = np.stack([in_plane(points[near_links.agent]), in_plane(near_links.q)], axis=1)
    ax.add_collection(lines(segment_ends, colors=PURPLE, linewidths=0.9, linestyles=":", zorder=2))
    plot_style = {"facecolors": "white", "edgecolors": PURPLE, "linewidths": 0.8, "zorder": 3}
    ax.scatter(*segment_ends[:, 1].T, s=0.7 * size, marker="D", label="β-agents", **plot_style)


def velocity_arrows(ax: Any, q: Any, p: Any) -> str:
    """Draw velocities as arrows; return a note on their scale for the title, empty without arrows."""
    x, v = in_plane(value_checks.ensure_points("q", q)), in_plane(value_checks.ensure_points("p", p))
    fastest = float(np.linalg.norm(v, axis=1).max())
    extent = float(np.ptp(x, axis=0).max()) or 1.0
    if fastest == 0.0:
        return ""
    plot_style: dict[str, Any] = {"length": _ARROW * extent / fastest, "linewidth": 0.6, "arrow_length_ratio": 0.25}
    if x.shape[1] != 3:
        plot_style = {"angles": "xy", "scale_units": "width", "scale": fastest / _ARROW, "width": 0.0022, "zorder": 2.5}
    ax.quiver(*x.T, *v.T, color=GREEN, **plot_style)
    return f"   longest arrow: {fastest:.3g} length/time"
