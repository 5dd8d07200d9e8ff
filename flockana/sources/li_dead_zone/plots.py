"""Force of the dead-zone law with its jumps, energies of a run, and a flock with its leaders."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.plots.palette import BLUE, GREEN, INK, MUTED, ORANGE, PURPLE, VERMILLION
from flockana.plots.snapshot import configuration, draw_sample, in_view
from flockana.plots.style import ensure_axes, finish, frame_space, in_plane, mark, over_time, star, write_title
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.with_leaders import LedDeadZoneFlocking

_SAMPLES = 300
_GROUPS = (ORANGE, PURPLE, GREEN, BLUE, VERMILLION)  # colours of leaders and their agents, again from the first


@check_kinds
def dead_zone_force(interaction: DeadZoneInteraction, *, ax: Axes | None = None) -> Axes:
    """Draw F from 0.7 d1 on against the distance of a pair (Fig. 2 of the paper), with a dot at its value at a jump."""
    ax = ensure_axes(ax)
    far = 1.15 * interaction.r  # towards 0 it falls to minus infinity
    edges = [0.7 * interaction.d1, *(x for x in (interaction.d1, interaction.d2, interaction.r) if x < far), far]
    for left, right in pairwise(edges):  # piece by piece: a jump is no steep line
        x = np.linspace(np.nextafter(left, far), np.nextafter(right, 0.0), _SAMPLES)
        ax.plot(x, -interaction.force(x), color=BLUE, linestyle="-")
    for jump in interaction.jumps():
        least_force = -float(interaction.force(jump.distance))
        for value in (jump.below, jump.above):
            face = BLUE if abs(value - least_force) <= 1e-9 * interaction.contact_force else "white"
            ax.plot(jump.distance, value, "o", color=BLUE, markerfacecolor=face, markersize=5, zorder=3)
    ax.axhline(0.0, color=MUTED, linewidth=0.8, linestyle="-")
    for name, position in (("d₁", interaction.d1), ("d₂", interaction.d2), ("r", interaction.r)):
        mark(ax, position, name)
    ax.set_xlim(0.0, far)
    write_title(ax, "below 0 it repels", color=MUTED, fontsize=8)
    return finish(ax, "distance of the pair (length)", "F, force along the line (length/time²)")


@over_time("energy (length²/time²)")
def dead_zone_energies(trajectory: Trajectory, ax: Any) -> None:
    """Draw the saturated energy H̄, which never rises, and the energy of neighbours, which jumps (erratum L5)."""
    metrics = trajectory.metrics()
    if "literal_energy" not in metrics:
        raise ArgumentError(f"law = {trajectory.law!r}: expected a run of DeadZoneFlocking")
    ax.plot(trajectory.t, trajectory.energy(), color=BLUE, linestyle="-", label="H̄, every pair, ψ constant beyond r")
    printed_energy = metrics.literal_energy.values
    ax.plot(trajectory.t, printed_energy, color=VERMILLION, linestyle="--", label="H, neighbours only (printed)")


@draw_sample.register(LedDeadZoneFlocking)
def _led(
    law: LedDeadZoneFlocking, trajectory: Trajectory, k: int, *, ax: Axes | None, velocities: bool, bar: bool
) -> Axes:
    """Draw each agent in its leader's colour, leaders as stars, pinned agents ringed, links within 1.1 d1."""
    q, t = trajectory.q[k], float(trajectory.t[k])
    p, contact_distance = trajectory.p[k] if velocities else None, 1.1 * law.interaction.d1
    axes: Any = configuration(q, p, r=contact_distance, ax=ax, title=f"t = {t:.4g}")
    positions = in_plane(np.array([leader.position(t) for leader in law.leaders]))
    x, marker_size = in_plane(q), float(np.clip(900.0 / len(q), 3.0, 26.0))
    for number, (members, position) in enumerate(zip(law.ties.members, positions, strict=True)):
        colour = _GROUPS[number % len(_GROUPS)]
        rings = [INK if i in law.pinned else colour for i in members.tolist()]
        axes.scatter(*x[members].T, s=1.6 * marker_size, color=colour, edgecolors=rings, linewidths=1.0, zorder=3.5)
        star(axes, position[None, :], color=colour)
    framed_axes: Axes = frame_space(axes, np.vstack([x, positions]), trajectory.m)
    return framed_axes


@in_view.register(LedDeadZoneFlocking)
def _led_in_view(law: LedDeadZoneFlocking, trajectory: Trajectory) -> FloatArray:
    paths = [np.array([leader.position(t) for t in trajectory.t.tolist()]) for leader in law.leaders]
    return np.concatenate([trajectory.q.reshape(-1, trajectory.m), *paths])
