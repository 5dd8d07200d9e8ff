"""Zone-based flocking: snapshots with obstacle zones, box and aliens, and series against their bounds."""

from collections.abc import Iterable
from itertools import combinations, product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Circle, Polygon, Rectangle

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import Sphere
from flockana.measures.nets import links
from flockana.plots.obstacles import bounds
from flockana.plots.obstacles import obstacles as draw_obstacles
from flockana.plots.palette import BLUE, FAINT, GREEN, INK, MUTED, ORANGE, PURPLE, VERMILLION
from flockana.plots.snapshot import configuration, draw_sample, in_view, nearest_sample, velocity_arrows
from flockana.plots.style import curves, ensure_axes, frame_space, hairlines, levels, lines, over_time, write_title
from flockana.plots.time_series import pair_distances
from flockana.sources.jond_2025.environment.zone_world import ZoneWorld
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking

_AS_LINES = 5000  # pairs


def _law(trajectory: Trajectory) -> ZoneFlocking:
    if not isinstance(trajectory.law, ZoneFlocking):
        raise ArgumentError(f"law = {trajectory.law!r}: expected a run of ZoneFlocking")
    return trajectory.law


def zones(
    trajectory: Trajectory, time: float | None = None, *, ax: Axes | None = None, velocities: bool = False
) -> Axes:
    """Draw one sample of a zone-based run: agents, obstacle zones, links within radius a, obstacles, aliens.

    In the plane an obstacle zone is a triangle ahead of its agent; in space the heading stands for it. Of the
    conventional method the circular buffers are drawn instead. `snapshot` and films draw runs of ZoneFlocking so.

    Parameters
    ----------
    time : float, optional
        By default the end.
    """
    ensure_run(trajectory)
    law, m = _law(trajectory), trajectory.m
    if m == 1:
        raise ArgumentError("the agents live on a line: expected m = 2 or 3")
    k = nearest_sample(trajectory.t, time)
    q, heading = trajectory.q[k], trajectory.extra["heading"][k]
    axes = ensure_axes(ax, m=m)
    corners = [q, _corners(law.world, m)]
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
        corners.append(aliens)
        axes.scatter(*aliens.T, s=70, marker="X", color=VERMILLION, edgecolors="white", linewidths=0.6, zorder=4)
    fastest = velocity_arrows(axes, q, trajectory.p[k]) if velocities else ""
    write_title(axes, f"t = {trajectory.t[k]:.4g}{fastest}", fontsize=9)
    return frame_space(axes, np.vstack(corners), m)


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
    """Return the extreme points of obstacles and box that a plot must contain."""
    corners = [np.empty((0, m))]
    for obstacle in world.obstacles:
        corners.append(bounds([obstacle]) if isinstance(obstacle, Sphere) else np.array(obstacle.vertices))
    if world.box is not None:
        corners += [np.array([world.box.low]), np.array([world.box.high])]
    return np.vstack(corners)


def _triangles(ax: Any, q: FloatArray, p: FloatArray, heading: FloatArray, law: ZoneFlocking) -> None:
    """Draw the obstacle zone ahead of every agent that has a heading."""
    _, c, _, _ = law.radii.arrays(len(q))
    forward_vectors = heading * law.altitudes(p)[:, None]
    side_vectors = law.base * c[:, None] * np.column_stack([heading[:, 1], -heading[:, 0]])
    corners = np.stack([q + forward_vectors, q + side_vectors, q - side_vectors], axis=1)[heading.any(axis=1)]
    ax.add_collection(PolyCollection(list(corners), facecolors=BLUE, edgecolors=BLUE, alpha=0.25, linewidths=0.6))


def _world(ax: Any, world: ZoneWorld, *, buffer: bool) -> None:
    """Draw obstacles, buffers, territories and box."""
    grey: dict[str, Any] = {"facecolor": FAINT, "edgecolor": MUTED, "linewidth": 0.8, "zorder": 1}
    for obstacle in world.obstacles:
        disc = obstacle if isinstance(obstacle, Sphere) else obstacle.enclosing_circle()
        if isinstance(obstacle, Sphere):
            ax.add_patch(Circle(disc.centre, disc.radius, **grey))
        else:
            ax.add_patch(Polygon(obstacle.vertices, **grey))
        if buffer:
            ax.add_patch(Circle(disc.centre, disc.radius, fill=False, edgecolor=PURPLE, linestyle="--", linewidth=1.0))
    for alien in world.aliens:
        if (territory := alien.territory) is not None:
            ax.add_patch(Polygon(territory.vertices, facecolor=ORANGE, edgecolor=ORANGE, alpha=0.25, linewidth=0.8))
    if world.box is not None:
        box_size = np.subtract(world.box.high, world.box.low).tolist()
        ax.add_patch(Rectangle(world.box.low, *box_size, fill=False, edgecolor=INK, linewidth=1.2))


def _space(ax: Any, world: ZoneWorld) -> None:
    """Draw spherical obstacles and the edges of the box in three dimensions."""
    draw_obstacles(world.obstacles, ax=ax)  # type: ignore[arg-type]  # polygons live in the plane
    if world.box is not None:
        corners = list(product(*zip(world.box.low, world.box.high, strict=True)))
        edges = [pair for pair in combinations(corners, 2) if np.count_nonzero(np.subtract(*pair)) == 1]
        ax.add_collection(lines(edges, colors=INK, linewidths=0.8))


@over_time("distance (length)")
def zone_distances(trajectory: Trajectory, ax: Any) -> None:
    """Draw the distances of all pairs over time, the least of them, and the radii of the zones.

    Of more than some hundred agents the profile is drawn (`pair_distances`), as lines would be one blot.
    """
    law, t = _law(trajectory), trajectory.t
    first_agents, second_agents = np.triu_indices(trajectory.n, 1)
    if first_agents.size > _AS_LINES:
        pair_distances(trajectory, ax=ax)
    else:
        distances = lengths(trajectory.q[:, first_agents] - trajectory.q[:, second_agents])
        hairlines(ax, t, distances, "pairs", crowd=2)
        curves(ax, t, [(distances.min(axis=1), "least (D)", INK, "-")] if first_agents.size else ())
    levels(ax, zip(law.radii.reach, "rca", (VERMILLION, PURPLE, GREEN), ("--", "-.", ":"), strict=True))
    ax.set_ylim(bottom=0.0)


@over_time("speed (length/time)")
def zone_speeds(trajectory: Trajectory, ax: Any) -> None:
    """Draw the speeds of all agents, their mean, the desired speed and the bound."""
    law = _law(trajectory)
    _against_bound(ax, trajectory.t, lengths(trajectory.p), law.v_max, [(law.desired_speed, "desired", GREEN, ":")])


@over_time("input ‖u‖ (length/time²)")
def zone_controls(trajectory: Trajectory, ax: Any) -> None:
    """Draw the inputs of all agents, their mean and the bound."""
    _against_bound(ax, trajectory.t, lengths(trajectory.u), _law(trajectory).u_max)


@over_time("least distance (length)")
def zone_safety(trajectory: Trajectory, ax: Any) -> str | None:
    """Draw the distance of the flock from obstacles (bounded between the steps too), walls and aliens."""
    curves = [("obstacle_clearance_bound", "obstacle", BLUE, "-"), ("wall_distance", "wall", GREEN, "-.")]
    curves.append(("alien_distance", "alien", VERMILLION, "--"))
    if not _measured(ax, trajectory, curves):
        return "nothing to keep clear of"
    ax.axhline(0.0, color=INK, linewidth=0.8, linestyle="-")
    return None


@over_time("mean number of agents in the zone")
def zone_populations(trajectory: Trajectory, ax: Any) -> None:
    """Draw the mean numbers of agents in an agent's zones of repulsion, conflict and attraction."""
    styles = (("repulsion", VERMILLION, "--"), ("conflict", PURPLE, "-."), ("attraction", GREEN, ":"))
    _measured(ax, trajectory, [(f"in_{zone}", zone, colour, dash) for zone, colour, dash in styles])
    ax.set_ylim(bottom=0.0)


def _measured(ax: Any, trajectory: Trajectory, styles: Iterable[tuple[str, str, str, str]]) -> bool:
    """Draw those of the listed measures that a run has over time; return whether any is drawn."""
    _law(trajectory)
    metrics = trajectory.metrics()
    lines = [(metrics[name].values, label, colour, dash) for name, label, colour, dash in styles if name in metrics]
    curves(ax, trajectory.t, lines, width=1.1)
    return bool(lines)


def _against_bound(ax: Any, t: FloatArray, values: FloatArray, bound: float, others: Any = ()) -> None:
    """Draw a quantity of all agents over time, its mean and its bound."""
    hairlines(ax, t, values, "agents", crowd=2)
    curves(ax, t, [(values.mean(axis=1), "mean", INK, "-")])
    levels(ax, [*others, (bound, "bound", VERMILLION, "--")])
    ax.set_ylim(0.0, 1.08 * bound)
