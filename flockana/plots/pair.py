"""Curves of a pair law over the Euclidean distance."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.interactions import AlphaInteraction
from flockana.interactions.distance_functions import DistanceFunction
from flockana.measures.metrics import deviation_energy
from flockana.plots.palette import BLUE, MUTED, VERMILLION
from flockana.plots.style import ensure_axes, finish, mark, place_legend
from flockana.plots.symbol_typesetting import typeset

_SAMPLES = 600


@check_kinds
def action(interaction: AlphaInteraction, *, ax: Axes | None = None) -> Axes:
    """Draw φ_α over the distance of a pair: negative repels, positive attracts, 0 beyond r."""
    ax = ensure_axes(ax)
    x = np.linspace(0.0, 1.15 * interaction.r, _SAMPLES)
    ax.plot(x, interaction.phi_alpha(interaction.sigma_norm(x)), color=BLUE, linestyle="-")
    ax.axhline(0.0, color=MUTED, linewidth=0.8, linestyle="-")
    return _frame(ax, interaction, "φ_α, the pair's action")


@check_kinds
def force(function: DistanceFunction, *, ax: Axes | None = None) -> Axes:
    """Draw the force of any function of the distance, −dV/ds, with its zeros.

    Parameters
    ----------
    function : DistanceFunction
        A pair law or another function of finite range, such as `pair_law(...)`.

    Raises
    ------
    ArgumentError
        If the range is infinite.
    """
    if not np.isfinite(function.range):
        raise ArgumentError(f"{function!r} has no range: expected a pair law of finite range")
    ax, end = ensure_axes(ax), function.range
    x = np.linspace(0.0, 1.15 * end, _SAMPLES)[1:]
    values = function.force(x)
    is_plotted = x >= (0.0 if np.abs(values[0]) < 1e3 * np.abs(values[_SAMPLES // 2 :]).max() else 0.25 * end)
    ax.plot(x[is_plotted], values[is_plotted], color=BLUE, linestyle="-")
    ax.axhline(0.0, color=MUTED, linewidth=0.8, linestyle="-")
    for zero in function.facts.zeros or ():
        mark(ax, zero, f"{zero:.4g}", offset=(3, -9), height=1.0)
    ax.set_xlim(0.0, x[-1])
    return finish(ax, "distance of the pair (length)", "force −dV/ds: positive repels")


@check_kinds
def potential(interaction: AlphaInteraction, *, ax: Axes | None = None) -> Axes:
    """Draw ψ_α over the distance of a pair: least at d, constant beyond r, c* at 0."""
    ax = ensure_axes(ax)
    x = np.linspace(0.0, 1.15 * interaction.r, _SAMPLES)
    ax.plot(x, interaction.psi_alpha(interaction.sigma_norm(x)), color=VERMILLION, linestyle="-")
    text, c_star = typeset(f"c* = {interaction.c_star:.4g}"), interaction.c_star
    ax.annotate(text, (0.0, c_star), (30, -4), textcoords="offset points")
    return _frame(ax, interaction, "ψ_α, the pair's potential")


@check_kinds
def deviation(interaction: AlphaInteraction, *, ax: Axes | None = None) -> Axes:
    """Draw deviation energy E and potential V of a pair over its distance, relative to their values at 0.

    To the left of 0 one agent has passed through the other.
    """
    ax, d, r = ensure_axes(ax), interaction.d, interaction.r
    x = np.linspace(-0.5 * d, 1.15 * r, _SAMPLES)
    psi = interaction.psi_alpha(interaction.sigma_norm(np.abs(x))) / interaction.c_star
    ax.plot(x, psi, color=VERMILLION, linestyle="--", label="V, the pair's potential, over c*")
    zero, inside_range = deviation_energy([[0.0], [0.0]], d, r), np.nextafter(r, 0.0)
    distances = np.append(x[x < r], inside_range)
    values = np.array([deviation_energy([[0.0], [distance]], d, r) for distance in distances]) / zero
    ax.plot(distances, values, color=BLUE, linestyle="-", label="E, deviation energy, over E(0)")
    ax.plot([r, x[-1]], [0.0, 0.0], color=BLUE, linestyle="-")
    ax.plot([r], [values[-1]], "o", color=BLUE, markerfacecolor="white", markersize=5)
    ax.plot([r], [0.0], "o", color=BLUE, markersize=5)
    _frame(ax, interaction, "energy over its value at 0")
    ax.set(xlim=(x[0], x[-1]), xlabel="position of one agent relative to the other (length)")
    place_legend(ax)
    return ax


def _frame(ax: Axes, interaction: AlphaInteraction, label: str) -> Axes:
    for name in "dr":
        mark(ax, getattr(interaction, name), name, offset=(3, -9), height=1.0)
    ax.set_xlim(0.0, 1.15 * interaction.r)
    return finish(ax, "distance of the pair (length)", label)
