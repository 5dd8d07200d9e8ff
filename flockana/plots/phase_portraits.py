"""Phase portraits: velocity over position, with the level curves of an energy behind them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.plots.palette import BLUE, INK, MUTED, VERMILLION
from flockana.plots.style import ensure_axes, finish, line_width_and_opacity

_LEVELS = 14
_ORBITS = np.array([0.1, 0.3, 0.5, 0.7, 0.9, 1.25, 1.75, 2.5, 4.0])  # of the separatrix, from the least energy on


@check_kinds
def phase_portrait(
    position: ArrayLike,
    velocity: ArrayLike,
    *,
    energy: tuple[Any, Any, Any] | None = None,
    separatrix: float | None = None,
    labels: tuple[str, str] = ("position (length)", "velocity (length/time)"),
    ax: Axes | None = None,
) -> Axes:
    """Draw velocity over position, one curve per column, from a circle at the start to a dot at the end.

    Parameters
    ----------
    position, velocity : array_like, shape (T,) or (T, k)
        Of k degrees of freedom: distances of pairs and their rates, or deviations from a γ-agent.
    energy : (x, v, H), optional
        Grids of shape (b,), (a,) and (a, b): level curves of H are drawn behind the motion.
    separatrix : float, optional
        The energy that divides motions that stay from those that leave: its level curve is drawn, with orbits of less
        and of more energy about it.
    labels : (str, str)
        Of the axes, with units.
    """
    x, v = (np.asarray(values, dtype=np.float64) for values in (position, velocity))
    if x.shape != v.shape or x.ndim not in (1, 2):
        raise ArgumentError(f"position {x.shape}, velocity {v.shape}: expected equal shapes, (T,) or (T, k)")
    x, v = (values.reshape(len(values), -1) for values in (x, v))
    axes = ensure_axes(ax)
    if separatrix is not None and energy is None:
        raise ArgumentError(f"separatrix = {separatrix:g} without an energy: give energy=(x, v, H) too")
    if energy is not None:
        lowest_value = float(np.min(energy[2]))
        levels = _LEVELS if separatrix is None else lowest_value + _ORBITS * (separatrix - lowest_value)
        axes.contour(*energy, levels=levels, colors=MUTED, linewidths=0.6, alpha=0.7)
    if energy is not None and separatrix is not None:
        axes.contour(*energy, levels=[separatrix], colors=VERMILLION, linewidths=1.3)
        axes.plot([], [], color=VERMILLION, linestyle="-", linewidth=1.3, label="separatrix")
    axes.axhline(0.0, color=INK, linewidth=0.6, linestyle="-")
    width, alpha = line_width_and_opacity(x.shape[1])
    axes.plot(x, v, color=BLUE, linestyle="-", linewidth=width, alpha=alpha)
    axes.scatter(x[0], v[0], s=14, facecolors="white", edgecolors=BLUE, zorder=3)
    axes.scatter(x[-1], v[-1], s=14, color=BLUE, zorder=3)
    return finish(axes, *labels)
