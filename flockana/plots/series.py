"""Quantities of a run over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import FormatStrFormatter, MaxNLocator, NullFormatter

from flockana.base.errors import UnknownNameError
from flockana.base.vectors import lengths
from flockana.laws.discrete import DiscreteLaw
from flockana.measures.profiles import pair_distance_profile
from flockana.plots.dense import velocities_between
from flockana.plots.style import (
    BLUE,
    GREEN,
    INK,
    MUTED,
    PURPLE,
    VERMILLION,
    ensure_axes,
    finish_empty,
    finish_over_time,
    hairline,
    subplots,
)
from flockana.scenarios.findings import component_counts

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.dynamics.trajectory import Trajectory

_FEW = 12  # components that a linear scale shows as well
PANEL = ("connectivity", "cohesion_radius", "normalised_deviation_energy", "normalised_velocity_mismatch")


def measure(trajectory: Trajectory, name: str, *, ax: Axes | None = None) -> Axes:
    """Draw one of the run's metrics over time; left empty, and said so, where the law does not define it.

    Parameters
    ----------
    name : str
        A variable of ``trajectory.metrics()``.

    Raises
    ------
    UnknownNameError
        If there is no such metric.
    """
    drawn, ax = trajectory.measure(name), ensure_axes(ax)
    try:
        values = trajectory.metric(name)
    except UnknownNameError:
        return finish_empty(ax, drawn.label, "not defined for this law")
    ax.plot(trajectory.t, values, color=BLUE, linestyle="-")
    if drawn.logarithmic and (values > 0.0).any():
        ax.set_yscale("log")
    if drawn.at_most_one:
        ax.set_ylim(float(np.nanmin(values, initial=0.0)) - 0.03, 1.05)
    elif not drawn.logarithmic and not (values < 0.0).any():
        ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, trajectory.t, drawn.label)


def has_metric(trajectory: Trajectory, name: str) -> bool:
    """Whether a run has a metric, asked without all the others (which xarray holds, whose import takes longer)."""
    try:
        trajectory.metric(name)
    except UnknownNameError:
        return False
    return True


def panel(trajectory: Trajectory, *, ax: Any = None) -> Any:
    """Draw C, R, Ẽ and K̃ (logarithmic) side by side.

    Parameters
    ----------
    ax : sequence of four Axes, optional
        Where to draw; by default a new figure of two by two.

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (4,)
    """
    flat = np.ravel(subplots(2, 2, size=(8.4, 5.0))[1] if ax is None else ax)
    for name, each in zip(PANEL, flat, strict=True):
        measure(trajectory, name, ax=each)
    return flat


def energy(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the law's energy H over time, if it has one."""
    ax = ensure_axes(ax)
    values = trajectory.energy()
    if not np.isfinite(values).any():
        return finish_empty(ax, "H, energy", "this law has no energy")
    ax.plot(trajectory.t, values, color=BLUE, linestyle="-")
    return finish_over_time(ax, trajectory.t, "H, energy")


def energy_residual(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw H(t) − H(0) − ∫ dH/dt: what the integration got wrong, by the energy identity."""
    ax = ensure_axes(ax)
    label = "H − H(0) − ∫ dH/dt"
    if "work" not in trajectory.extra:
        return finish_empty(ax, label, "no energy balance: this law has no energy")
    ax.axhline(0.0, color=MUTED, linewidth=0.8, linestyle="-")
    ax.plot(trajectory.t, trajectory.energy_residual, color=VERMILLION, linestyle="-", linewidth=1.0)
    return finish_over_time(ax, trajectory.t, label)


def distances(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the least distance of two agents at the samples, its lower bound between them, and d and r.

    Parameters
    ----------
    trajectory : Trajectory
        The run. Between the steps of a map there is nothing to bound.
    """
    ax = ensure_axes(ax)
    label = "least distance (length)"
    if trajectory.n == 1:
        return finish_empty(ax, label, "one agent has no distances")
    t, least = trajectory.t, trajectory.metric("min_distance")
    ax.plot(t, least, color=BLUE, linestyle="-", linewidth=2.4, alpha=0.6, label="at the samples")
    if len(t) > 1 and not isinstance(trajectory.law, DiscreteLaw):
        bound = trajectory.closest_approach().lower_by_interval
        ax.stairs(bound, t, baseline=None, color=VERMILLION, linestyle="--", linewidth=1.0, label="lower bound between")
    for name, length, colour, dash in zip(
        "dr", trajectory.law.lattice or (), (GREEN, PURPLE), (":", "-."), strict=False
    ):
        ax.axhline(length, color=colour, linestyle=dash, linewidth=1.1, label=name)
    ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, trajectory.t, label)


def pair_distances(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the profile of all pairs' distances over time: least, quarters, median and largest."""
    ax, label = ensure_axes(ax), "distance of two agents (length)"
    if trajectory.n == 1:
        return finish_empty(ax, label, "one agent has no distances")
    least, low, middle, high, largest = pair_distance_profile(trajectory.q).T
    ax.fill_between(trajectory.t, least, largest, color=BLUE, alpha=0.15, linewidth=0.0, label="all pairs")
    ax.fill_between(trajectory.t, low, high, color=BLUE, alpha=0.3, linewidth=0.0, label="half of them")
    ax.plot(trajectory.t, middle, color=BLUE, linestyle="-", linewidth=1.4, label="median")
    ax.plot(trajectory.t, least, color=INK, linestyle="-", linewidth=1.3, label="least (D)")
    ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, trajectory.t, label)


def components(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the number of components of the net over time (logarithmic where many), if the law has an interaction range."""
    ax = ensure_axes(ax)
    label = "components of the net"
    if not has_metric(trajectory, "connectivity"):
        return finish_empty(ax, label, "not defined for this law")
    counts = component_counts(trajectory)
    ax.plot(trajectory.t, counts, color=BLUE, linestyle="-", drawstyle="steps-post")
    if counts.max() > _FEW:
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter(FormatStrFormatter("%d"))
        ax.yaxis.set_minor_formatter(NullFormatter())
    else:
        ax.yaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_ylim(0.8, max(2.5, 1.3 * float(counts.max())))
    return finish_over_time(ax, trajectory.t, label)


def clearances(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the least clearance of any agent from each obstacle at the samples, d', and the bound for all times."""
    ax = ensure_axes(ax)
    label = "least clearance (length)"
    solids = trajectory.law.obstacles
    if not solids:
        return finish_empty(ax, label, "there are no obstacles")
    t, q = trajectory.t, trajectory.q
    width, alpha = hairline(2 * len(solids))
    for k, solid in enumerate(solids):
        least = solid.clearance(q.reshape(-1, trajectory.m)).reshape(len(t), -1).min(axis=1)
        name = "each obstacle, at the samples" if k == 0 else None
        ax.plot(t, least, color=BLUE, linestyle="-", linewidth=width, alpha=alpha, label=name)
    bound = trajectory.clearance().lower
    ax.axhline(bound, color=VERMILLION, linestyle="--", linewidth=1.1, label="lower bound for all times")
    if (field := trajectory.law.obstacle_field) is not None:
        beta = field.beta
        ax.axhline(beta.d, color=GREEN, linestyle=":", linewidth=1.1, label="d'")
        ax.set_ylim(min(0.0, bound), max(6.0 * beta.d, 1.5 * bound))
    ax.axhline(0.0, color=INK, linewidth=0.8, linestyle="-")
    return finish_over_time(ax, trajectory.t, label)


def speeds(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw every agent's speed, the speed of the centre of mass, and the γ-agent's as handed to the law."""
    ax = ensure_axes(ax)
    (t, p), target = velocities_between(trajectory), trajectory.law.target
    speed = lengths(p)
    width, alpha = hairline(trajectory.n)
    ax.plot(t, speed, color=BLUE, linestyle="-", linewidth=width, alpha=alpha)
    ax.plot([], [], color=BLUE, linestyle="-", linewidth=0.8, label="agents")
    centre = np.linalg.norm(p.mean(axis=1), axis=1)
    ax.plot(t, centre, color=INK, linestyle="-", linewidth=1.4, label="centre of mass")
    if target is not None:
        handed = [np.linalg.norm(target.state(s)[1]) for s in t.tolist()]
        ax.plot(t, handed, color=VERMILLION, linestyle="--", label="γ-agent's ‖p_r‖")
    ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, trajectory.t, "speed (length/time)")


def centre_of_mass(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw each coordinate of the centre of mass over time (solid), against the γ-agent's (dashed)."""
    ax = ensure_axes(ax)
    t, centre, target = trajectory.t, trajectory.q.mean(axis=1), trajectory.law.target
    for k, colour in zip(range(trajectory.m), (BLUE, GREEN, PURPLE), strict=False):
        ax.plot(t, centre[:, k], color=colour, linestyle="-", linewidth=1.8, label=f"{'xyz'[k]} of the centre")
    if target is not None:
        path = np.array([target.position(s) for s in t.tolist()])
        for k, colour in zip(range(trajectory.m), (BLUE, GREEN, PURPLE), strict=False):
            ax.plot(t, path[:, k], color=colour, linestyle="--", linewidth=1.1, label=f"{'xyz'[k]} of the γ-agent")
    return finish_over_time(ax, trajectory.t, "position (length)")
