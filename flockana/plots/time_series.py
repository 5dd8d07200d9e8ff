"""Plots of quantities of a run over time."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FormatStrFormatter, MaxNLocator, NullFormatter
from scipy.interpolate import CubicHermiteSpline

from flockana.base.errors import UnknownNameError
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.measures.distance_profiles import pair_distance_profile
from flockana.plots.palette import BLUE, FAINT, GREEN, INK, MUTED, PURPLE, VERMILLION
from flockana.plots.style import (
    curves,
    ensure_axes,
    finish_empty,
    finish_over_time,
    hairlines,
    levels,
    line_width_and_opacity,
    over_time,
    subplots,
)
from flockana.scenarios.report_claims import PANEL, component_counts, has_metric

_FEW = 12  # components that a linear scale shows as well
_INSTANTS = 1500  # about as many as a figure has pixels across


def measure(trajectory: Trajectory, name: str, *, ax: Axes | None = None) -> Axes:
    """Draw one metric of a run over time; empty axes say why where the law does not define it."""
    ensure_run(trajectory)
    lines, ax = trajectory.measure(name), ensure_axes(ax)
    try:
        values = trajectory.metric(name)
    except UnknownNameError:
        return finish_empty(ax, lines.label, "not defined for this law")
    ax.plot(trajectory.t, values, color=BLUE, linestyle="-")
    logarithmic = lines.logarithmic or _spans_decades(values)
    if logarithmic and (values > 0.0).any():
        ax.set_yscale("log")
        _shade_floor(trajectory, name, values, ax)
    if lines.at_most_one:
        ax.set_ylim(float(np.nanmin(values, initial=0.0)) - 0.03, 1.05)
    elif not logarithmic and not (values < 0.0).any():
        ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, trajectory.t, lines.label)


def _spans_decades(values: Any) -> bool:
    """Return whether values that are not negative span three decades or more."""
    positive = values[values > 0.0]
    return bool(positive.size > 1 and not (values < 0.0).any() and positive.max() > 1e3 * positive.min())


def _shade_floor(trajectory: Trajectory, name: str, values: Any, ax: Any) -> None:
    """Shade the values of a measure that are below the effect of the solver's error of one step."""
    position_error, speed, _ = trajectory.floors
    d = trajectory.scales.length
    floor = {
        "normalised_velocity_mismatch": 0.5 * speed**2,
        "velocity_diameter": 2.0 * speed,
        "normalised_deviation_energy": (2.0 * position_error / d) ** 2,
    }.get(name, 0.0)
    positive_values = values[values > 0.0]
    if floor > 0.0 and positive_values.min() < floor:
        ax.axhspan(positive_values.min(), floor, color=FAINT, alpha=0.6, linewidth=0.0, label="noise floor")


def panel(trajectory: Trajectory, *, ax: Any = None) -> Any:
    """Draw connectivity C, cohesion radius R, deviation energy Ẽ and velocity mismatch K̃ in four panels.

    Parameters
    ----------
    ax : sequence of four Axes, optional
        Where to draw; by default a new figure of two by two.

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (4,)
    """
    ensure_run(trajectory)
    flat_axes = np.ravel(subplots(2, 2, size=(8.4, 5.0))[1] if ax is None else ax)
    for name, item in zip(PANEL, flat_axes, strict=True):
        measure(trajectory, name, ax=item)
    return flat_axes


@over_time("H, energy")
def energy(trajectory: Trajectory, ax: Any) -> str | None:
    """Draw the law's energy H over time; empty axes without an energy."""
    values = trajectory.energy()
    if not np.isfinite(values).any():
        return "this law has no energy"
    ax.plot(trajectory.t, values, color=BLUE, linestyle="-")
    return None


@over_time("H − H(0) − ∫ dH/dt")
def energy_residual(trajectory: Trajectory, ax: Any) -> str | None:
    """Draw H(t) − H(0) − ∫ dH/dt, the error of the integration by the energy identity."""
    if "work" not in trajectory.extra:
        return "no energy balance: the run carries no ∫ dH/dt"
    ax.axhline(0.0, color=MUTED, linewidth=0.8, linestyle="-")
    ax.plot(trajectory.t, trajectory.energy_residual, color=VERMILLION, linestyle="-", linewidth=1.0)
    return None


@over_time("least distance (length)")
def distances(trajectory: Trajectory, ax: Any) -> str | None:
    """Draw the least distance of two agents at the samples, a lower bound between samples (of flows), and d and r."""
    if trajectory.n == 1:
        return "one agent has no distances"
    t, min_distance = trajectory.t, trajectory.metric("min_distance")
    ax.plot(t, min_distance, color=BLUE, linestyle="-", linewidth=2.4, alpha=0.6, label="at the samples")
    if len(t) > 1 and not trajectory.law.is_map:
        bound = trajectory.closest_approach().lower_by_interval
        ax.stairs(
            bound,
            t,
            baseline=None,
            color=VERMILLION,
            linestyle="--",
            linewidth=1.0,
            label="lower bound between samples",
        )
    levels(ax, zip(trajectory.law.lattice or (), "dr", (GREEN, PURPLE), (":", "-."), strict=False))
    ax.set_ylim(bottom=0.0)
    return None


@over_time("distance of two agents (length)")
def pair_distances(trajectory: Trajectory, ax: Any) -> str | None:
    """Draw the profile of all pairs' distances over time: least, quarters, median and largest."""
    if trajectory.n == 1:
        return "one agent has no distances"
    smallest, low, median, high, largest = pair_distance_profile(trajectory.q).T
    ax.fill_between(trajectory.t, smallest, largest, color=BLUE, alpha=0.15, linewidth=0.0, label="all pairs")
    ax.fill_between(trajectory.t, low, high, color=BLUE, alpha=0.3, linewidth=0.0, label="half of the pairs")
    curves(ax, trajectory.t, ((median, "median", BLUE, "-"), (smallest, "least (D)", INK, "-")))
    ax.set_ylim(bottom=0.0)
    return None


@over_time("components of the net")
def components(trajectory: Trajectory, ax: Any) -> str | None:
    """Draw the number of components of the net over time, logarithmic if large."""
    if not has_metric(trajectory, "connectivity"):
        return "not defined for this law"
    counts = component_counts(trajectory)
    ax.plot(trajectory.t, counts, color=BLUE, linestyle="-", drawstyle="steps-post")
    if counts.max() > _FEW:
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter(FormatStrFormatter("%d"))
        ax.yaxis.set_minor_formatter(NullFormatter())
    else:
        ax.yaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_ylim(0.8, max(2.5, 1.3 * float(counts.max())))
    return None


@over_time("least clearance (length)")
def clearances(trajectory: Trajectory, ax: Any) -> str | None:
    """Draw the least clearance of any agent from each obstacle at the samples, d', and the bound for all times."""
    solids = trajectory.law.obstacles
    if not solids:
        return "there are no obstacles"
    t, q = trajectory.t, trajectory.q
    (width, alpha), few = line_width_and_opacity(2 * len(solids)), len(solids) <= 3
    for k, obstacle in enumerate(solids):
        smallest = obstacle.clearance(q.reshape(-1, trajectory.m)).reshape(len(t), -1).min(axis=1)
        name = f"{type(obstacle).__name__.lower()} {k + 1}" if few else None if k else "each obstacle, at the samples"
        colour, dash = ((BLUE, "-"), (PURPLE, "-."), (INK, (0, (5, 1))))[k if few else 0]
        ax.plot(t, smallest, color=colour, linestyle=dash, linewidth=width, alpha=alpha, label=name)
    bound = trajectory.clearance().lower
    if np.isfinite(bound):  # of samples alone nothing is known between them
        levels(ax, [(bound, "lower bound for all times", VERMILLION, "--")])
    else:
        bound = 0.0
    if (field := trajectory.law.obstacle_field) is not None:
        levels(ax, [(field.beta.d, "d'", GREEN, ":")])
        ax.set_ylim(min(0.0, bound), max(6.0 * field.beta.d, 1.5 * bound))
    ax.axhline(0.0, color=INK, linewidth=0.8, linestyle="-")
    return None


@over_time("speed (length/time)")
def speeds(trajectory: Trajectory, ax: Any) -> None:
    """Draw every agent's speed, the speed of the centre of mass, and the γ-agent's as handed to the law."""
    (t, p), target = velocities_between(trajectory), trajectory.law.target
    hairlines(ax, t, lengths(p), "agents")
    curves(ax, t, [(np.linalg.norm(p.mean(axis=1), axis=1), "centre of mass", INK, "-")])
    if target is not None:
        target_speeds = np.array([np.linalg.norm(target.state(s)[1]) for s in t.tolist()])
        curves(ax, t, [(target_speeds, "γ-agent's ‖p_r‖", VERMILLION, "--")])
    ax.set_ylim(bottom=0.0)


@over_time("position (length)")
def centre_of_mass(trajectory: Trajectory, ax: Any) -> None:
    """Draw each coordinate of the centre of mass over time (solid), against the γ-agent's (dashed)."""
    t, colours = trajectory.t, (BLUE, GREEN, PURPLE)
    paths = [(trajectory.q.mean(axis=1), "centre", "-", 1.8)]
    if (target := trajectory.law.target) is not None:
        paths.append((np.array([target.position(s) for s in t.tolist()]), "γ-agent", "--", 1.1))
    for path, name, dash, width in paths:
        path_rows = zip(path.T, "xyz", colours, strict=False)
        curves(ax, t, ((x, f"{axis} of the {name}", colour, dash) for x, axis, colour in path_rows), width=width)


def velocities_between(trajectory: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Return times and velocities within the solver's steps, by cubics through velocities and accelerations."""
    ensure_run(trajectory)
    t, _, p, u, _ = trajectory.path
    parts = -(-_INSTANTS // max(1, len(t) - 1))
    if trajectory.law.is_map or len(t) < 2 or parts == 1:
        return t, p
    times = (t[:-1, None] + np.diff(t)[:, None] * np.arange(parts) / parts).ravel()
    return np.append(times, t[-1]), np.concatenate([CubicHermiteSpline(t, p, u)(times), p[-1:]])
