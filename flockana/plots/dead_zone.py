"""The force of the dead-zone law with its jumps, and the two energies of a run."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.plots.style import BLUE, MUTED, VERMILLION, ensure_axes, finish

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.dynamics.trajectory import Trajectory
    from flockana.interactions import DeadZoneInteraction

_SAMPLES = 300


def dead_zone_force(interaction: DeadZoneInteraction, *, nearest: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw F over the distance of a pair (Fig. 2 of the paper): where it jumps, a dot on the end that it takes.

    Parameters
    ----------
    interaction : DeadZoneInteraction
        The pair law.
    nearest : float, optional
        Where the curve begins, 0.7 d1 by default: it falls to minus infinity at 0.
    ax : matplotlib.axes.Axes, optional
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ArgumentError
        If `nearest` is not between 0 and d1.
    """
    nearest = 0.7 * interaction.d1 if nearest is None else nearest
    if not 0.0 < nearest < interaction.d1:
        raise ArgumentError(f"nearest = {nearest!r}: expected a distance between 0 and d1 = {interaction.d1:g}")
    ax = ensure_axes(ax)
    far = 1.15 * interaction.r
    edges = [nearest, *(x for x in (interaction.d1, interaction.d2, interaction.r) if x < far), far]
    for left, right in pairwise(edges):  # piece by piece: a jump is no steep line
        x = np.linspace(np.nextafter(left, far), np.nextafter(right, 0.0), _SAMPLES)
        ax.plot(x, interaction.force(x), color=BLUE, linestyle="-")
    for jump in interaction.jumps():
        taken = float(interaction.force(jump.distance))
        for value in (jump.below, jump.above):
            face = BLUE if abs(value - taken) <= 1e-9 * interaction.contact_force else "white"
            ax.plot(jump.distance, value, "o", color=BLUE, markerfacecolor=face, markersize=5, zorder=3)
    ax.axhline(0.0, color=MUTED, linewidth=0.8, linestyle="-")
    for name, place in (("d₁", interaction.d1), ("d₂", interaction.d2), ("r", interaction.r)):
        ax.axvline(place, color=MUTED, linewidth=0.8, linestyle=":")
        ax.annotate(name, (place, 0.0), (3, 4), xycoords=("data", "axes fraction"), textcoords="offset points")
    ax.set_xlim(0.0, far)
    ax.set_title("below 0 it repels", color=MUTED, fontsize=8)
    return finish(ax, "distance of the pair (length)", "F, force along the line (length/time²)")


def dead_zone_energies(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
    """Draw the saturated energy H̄, which never rises, and the energy of neighbours, which jumps (erratum L5).

    Parameters
    ----------
    trajectory : Trajectory
        A run of the dead-zone law.
    ax : matplotlib.axes.Axes, optional
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ArgumentError
        If the law measures no energy of neighbours.
    """
    metrics = trajectory.metrics()
    if "literal_energy" not in metrics:
        raise ArgumentError(f"law = {trajectory.law!r}: expected a run of DeadZoneFlocking")
    ax = ensure_axes(ax)
    ax.plot(trajectory.t, trajectory.energy(), color=BLUE, linestyle="-", label="H̄, every pair, ψ constant beyond r")
    printed = metrics.literal_energy.values
    ax.plot(trajectory.t, printed, color=VERMILLION, linestyle="--", label="H, neighbours only (printed)")
    return finish(ax, "t (time)", "energy (length²/time²)")
