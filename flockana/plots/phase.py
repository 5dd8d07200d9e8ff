"""Phase portraits: velocity over position, with the level curves of an energy behind them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.plots.style import BLUE, FAINT, INK, ensure_axes, finish, hairline

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LEVELS = 14


def phase_portrait(
    position: Any,
    velocity: Any,
    *,
    energy: tuple[Any, Any, Any] | None = None,
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
    labels : (str, str)
        Of the axes, with units.
    ax : matplotlib.axes.Axes, optional
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ArgumentError
        If the two do not have the same shape.
    """
    x, v = (np.asarray(values, dtype=np.float64) for values in (position, velocity))
    if x.shape != v.shape or x.ndim not in (1, 2):
        raise ArgumentError(f"position {x.shape}, velocity {v.shape}: expected equal shapes, (T,) or (T, k)")
    x, v = (values.reshape(len(values), -1) for values in (x, v))
    axes = ensure_axes(ax)
    if energy is not None:
        axes.contour(*energy, levels=_LEVELS, colors=FAINT, linewidths=0.8)
    axes.axhline(0.0, color=INK, linewidth=0.6, linestyle="-")
    width, alpha = hairline(x.shape[1])
    axes.plot(x, v, color=BLUE, linestyle="-", linewidth=width, alpha=alpha)
    axes.scatter(x[0], v[0], s=14, facecolors="white", edgecolors=BLUE, zorder=3)
    axes.scatter(x[-1], v[-1], s=14, color=BLUE, zorder=3)
    return finish(axes, *labels)
