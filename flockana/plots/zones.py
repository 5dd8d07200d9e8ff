"""Zone-based flocking: one instant with obstacle zones, box and aliens, and its series against their bounds."""

from __future__ import annotations

from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.patches import Circle, Polygon, Rectangle

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.base.vectors import lengths
from flockana.environment.obstacles import Sphere
from flockana.environment.zone_world import ZoneWorld
from flockana.laws.bearing_distance import ZoneFlocking
from flockana.measures.nets import links
from flockana.plots.obstacles import bounds
from flockana.plots.obstacles import obstacles as draw_obstacles
from flockana.plots.series import pair_distances
from flockana.plots.snapshot import configuration, draw_sample, in_view, nearest_sample, velocity_arrows
from flockana.plots.style import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    MUTED,
    ORANGE,
    PURPLE,
    VERMILLION,
    ensure_axes,
    finish_over_time,
    frame_space,
    hairline,
    head,
    lines,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.dynamics.trajectory import Trajectory

_AS_LINES = 5000  # pairs


def _law(trajectory: Trajectory) -> ZoneFlocking:
    if not isinstance(trajectory.law, ZoneFlocking):
        raise ArgumentError(f"law = {trajectory.law!r}: expected a run of ZoneFlocking")
    return trajectory.law


def zones(
    trajectory: Trajectory, time: float | None = None, *, ax: Axes | None = None, velocities: bool = False
) -> Axes:
    """Draw the sample nearest to a time: agents with their obstacle zones, links within a, world, aliens.

    In the plane an obstacle zone is a triangle ahead of its agent; in space the heading stands for it. Of the
    conventional method the circular buffers are drawn instead. `snapshot` and films draw runs of ZoneFlocking so.

    Parameters
    ----------
    time : float, optional
        By default the end.

    Raises
    ------
    ArgumentError
        If it is a run of another law, or of agents on a line, or on a time that is not of the run.
    """
    law, m = _law(trajectory), trajectory.m
    if m == 1:
        raise ArgumentError("the agents live on a line: expected m = 2 or 3")
    k = nearest_sample(trajectory.t, time)
    q, heading = trajectory.q[k], trajectory.extra["heading"][k]
    axes = ensure_axes(ax, m=m)
    seen = [q, _corners(law.world, m)]
    if m == 2:
        _world(axes, law.world, buffer=law.obstacle_zone == "buffer")
        if law.obstacle_zone == "triangle":
            _triangles(axes, q, trajectory.p[k], heading, law)
    else:
        _space(axes, law.world)
    pairs = links(q, float(np.nextafter(law.radii.reach[2], np.inf)))
    axes.add_collection(lines(q[pairs], colors=MUTED, linewidths=0.8, alpha=0.7, zorder=2))
    axes.scatter(*q.T, s=22, color=INK, linewidths=0, zorder=3, label="agents")
    if m == 3:
        axes.quiver(*q.T, *heading.T, length=law.radii.reach[1], color=BLUE, linewidth=0.8)
    if "alien" in trajectory.extra:
        aliens = trajectory.extra["alien"][k]
        seen.append(aliens)
        axes.scatter(*aliens.T, s=70, marker="X", color=VERMILLION, edgecolors="white", linewidths=0.6, zorder=4)
    fastest = velocity_arrows(axes, q, trajectory.p[k]) if velocities else ""
    head(axes, f"t = {trajectory.t[k]:.4g}{fastest}", fontsize=9)
    return frame_space(axes, np.vstack(seen), m)


@draw_sample.register(ZoneFlocking)
def _(law: Any, trajectory: Trajectory, k: int, *, ax: Axes | None, velocities: bool, bar: bool) -> Axes:
    if trajectory.m > 1:
        return zones(trajectory, float(trajectory.t[k]), ax=ax, velocities=velocities)
    p = trajectory.p[k] if velocities else None
    return configuration(trajectory.q[k], p, r=law.radii.reach[2], ax=ax, title=f"t = {trajectory.t[k]:.4g}")


@in_view.register(ZoneFlocking)
def _(law: Any, trajectory: Trajectory) -> FloatArray:
    m = trajectory.m
    aliens = trajectory.extra.get("alien", np.empty((0, m)))
    return np.vstack([trajectory.q.reshape(-1, m), aliens.reshape(-1, m), _corners(law.world, m)])


def _corners(world: ZoneWorld, m: int) -> FloatArray:
    """Points that must be in view: obstacles and box."""
    seen = [np.empty((0, m))]
    for solid in world.obstacles:
        seen.append(bounds([solid]) if isinstance(solid, Sphere) else np.array(solid.vertices))
    if world.box is not None:
        seen += [np.array([world.box.low]), np.array([world.box.high])]
    return np.vstack(seen)


def _triangles(ax: Any, q: FloatArray, p: FloatArray, heading: FloatArray, law: ZoneFlocking) -> None:
    """The obstacle zone ahead of every agent that has a heading."""
    _, c, _, _ = law.radii.arrays(len(q))
    ahead = heading * law.altitudes(p)[:, None]
    aside = law.base * c[:, None] * np.column_stack([heading[:, 1], -heading[:, 0]])
    corners = np.stack([q + ahead, q + aside, q - aside], axis=1)[heading.any(axis=1)]
    ax.add_collection(PolyCollection(list(corners), facecolors=BLUE, edgecolors=BLUE, alpha=0.25, linewidths=0.6))


def _world(ax: Any, world: ZoneWorld, *, buffer: bool) -> None:
    """Draw obstacles, buffers, territories and box."""
    for solid in world.obstacles:
        disc = solid if isinstance(solid, Sphere) else solid.enclosing_circle()
        if isinstance(solid, Sphere):
            ax.add_patch(Circle(disc.centre, disc.radius, facecolor=FAINT, edgecolor=MUTED, linewidth=0.8, zorder=1))
        else:
            ax.add_patch(Polygon(solid.vertices, facecolor=FAINT, edgecolor=MUTED, linewidth=0.8, zorder=1))
        if buffer:
            ax.add_patch(Circle(disc.centre, disc.radius, fill=False, edgecolor=PURPLE, linestyle="--", linewidth=1.0))
    for alien in world.aliens:
        if alien.territory is not None:
            ax.add_patch(
                Polygon(alien.territory.vertices, facecolor=ORANGE, edgecolor=ORANGE, alpha=0.25, linewidth=0.8)
            )
    if world.box is not None:
        low, high = np.array(world.box.low), np.array(world.box.high)
        width, height = (high - low).tolist()
        ax.add_patch(Rectangle(world.box.low, width, height, fill=False, edgecolor=INK, linewidth=1.2))


def _space(ax: Any, world: ZoneWorld) -> None:
    """Draw balls and the edges of the box in space."""
    draw_obstacles(world.obstacles, ax=ax)  # type: ignore[arg-type]  # polygons live in the plane
    if world.box is not None:
        corners = list(product(*zip(world.box.low, world.box.high, strict=True)))
        edges = [pair for pair in combinations(corners, 2) if np.count_nonzero(np.subtract(*pair)) == 1]
        ax.add_collection(lines(edges, colors=INK, linewidths=0.8))


def zone_distances(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the distances of all pairs over time, the least of them, and the radii of the zones.

    Of more than some hundred agents the profile is drawn (`pair_distances`), as lines would be one blot.
    """
    law, ax = _law(trajectory), ensure_axes(ax)
    first, second = np.triu_indices(trajectory.n, 1)
    if first.size > _AS_LINES:
        pair_distances(trajectory, ax=ax)
    else:
        apart = lengths(trajectory.q[:, first] - trajectory.q[:, second])
        width, alpha = hairline(2 * max(1, first.size))
        ax.plot(trajectory.t, apart, color=BLUE, linestyle="-", linewidth=width, alpha=alpha)
        ax.plot([], [], color=BLUE, linestyle="-", linewidth=0.8, label="pairs")
        if first.size:
            ax.plot(trajectory.t, apart.min(axis=1), color=INK, linestyle="-", linewidth=1.3, label="least (D)")
    looks = (("r", VERMILLION, "--"), ("c", PURPLE, "-."), ("a", GREEN, ":"))
    for radius, (name, colour, dash) in zip(law.radii.reach, looks, strict=True):
        ax.axhline(radius, color=colour, linestyle=dash, linewidth=1.1, label=name)
    ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, trajectory.t, "distance (length)")


def zone_speeds(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the speeds of all agents, their mean, the desired speed and the bound."""
    law, ax = _law(trajectory), ensure_axes(ax)
    _agents(ax, trajectory, lengths(trajectory.p))
    ax.axhline(law.desired_speed, color=GREEN, linestyle=":", linewidth=1.2, label="desired")
    ax.axhline(law.v_max, color=VERMILLION, linestyle="--", linewidth=1.1, label="bound")
    ax.set_ylim(0.0, 1.08 * law.v_max)
    return finish_over_time(ax, trajectory.t, "speed (length/time)")


def zone_controls(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the inputs of all agents, their mean and the bound."""
    law, ax = _law(trajectory), ensure_axes(ax)
    _agents(ax, trajectory, lengths(trajectory.u))
    ax.axhline(law.u_max, color=VERMILLION, linestyle="--", linewidth=1.1, label="bound")
    ax.set_ylim(0.0, 1.08 * law.u_max)
    return finish_over_time(ax, trajectory.t, "input ‖u‖ (length/time²)")


def zone_safety(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw how near the flock comes to obstacles (bound between the steps too), to walls and to aliens."""
    _law(trajectory)
    ax, metrics = ensure_axes(ax), trajectory.metrics()
    shown = (
        ("obstacle_clearance_bound", "obstacle", BLUE, "-"),
        ("wall_distance", "wall", GREEN, "-."),
        ("alien_distance", "alien", VERMILLION, "--"),
    )
    for name, label, colour, dash in shown:
        if name in metrics:
            ax.plot(trajectory.t, metrics[name].values, color=colour, linestyle=dash, linewidth=1.1, label=label)
    if not ax.get_legend_handles_labels()[0]:
        ax.set_yticks([])
        ax.text(0.5, 0.5, "nothing to keep clear of", ha="center", va="center", transform=ax.transAxes, color=MUTED)
    else:
        ax.axhline(0.0, color=INK, linewidth=0.8, linestyle="-")
    return finish_over_time(ax, trajectory.t, "least distance (length)")


def zone_populations(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw how many agents are in the zones of repulsion, conflict and attraction of an agent, on the mean."""
    _law(trajectory)
    ax, metrics = ensure_axes(ax), trajectory.metrics()
    for zone, colour, dash in (("repulsion", VERMILLION, "--"), ("conflict", PURPLE, "-."), ("attraction", GREEN, ":")):
        ax.plot(trajectory.t, metrics[f"in_{zone}"].values, color=colour, linestyle=dash, linewidth=1.2, label=zone)
    ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, trajectory.t, "agents in the zone, mean")


def _agents(ax: Any, trajectory: Trajectory, values: FloatArray) -> None:
    width, alpha = hairline(2 * trajectory.n)
    ax.plot(trajectory.t, values, color=BLUE, linestyle="-", linewidth=width, alpha=alpha)
    ax.plot([], [], color=BLUE, linestyle="-", linewidth=0.8, label="agents")
    ax.plot(trajectory.t, values.mean(axis=1), color=INK, linestyle="-", linewidth=1.4, label="mean")
