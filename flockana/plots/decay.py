"""Range of validity of a linearisation, and measured gains on a Bode plot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from flockana.base.argument_kinds import check_kinds
from flockana.plots.palette import BLUE, GREEN, INK, MUTED, PURPLE, VERMILLION
from flockana.plots.style import ensure_axes, finish, mark

_LOOKS = ((BLUE, "o", "-"), (VERMILLION, "s", "--"), (GREEN, "^", "-."), (PURPLE, "D", ":"))


@check_kinds
def linear_range(
    ranges: Mapping[str, tuple[Any, Any, Any]], *, marks: Mapping[str, float] | None = None, ax: Axes | None = None
) -> Axes:
    """Draw the deviation from the linear prediction against the perturbation, both logarithmic, with a line of slope 1.

    Parameters
    ----------
    ranges : mapping of str to (amplitudes, deviations, net changes)
        By label: displacement in units of d, deviation over displacement, and where links form or break (filled white).
    marks : mapping of str to float, optional
        Amplitudes to point out, by label.
    """
    ax = ensure_axes(ax)
    for k, (label, (magnitudes, deviations, changes)) in enumerate(ranges.items()):
        colour, marker, dash = _LOOKS[k % len(_LOOKS)]
        x, y, is_changed = np.asarray(magnitudes), np.asarray(deviations), np.asarray(changes, dtype=bool)
        ax.plot(x, y, color=colour, linestyle=dash, linewidth=1.2, zorder=2)
        plot_style: Any = {"marker": marker, "color": colour, "linestyle": "none", "zorder": 3}
        ax.plot(x[~is_changed], y[~is_changed], markersize=4.5, label=label, **plot_style)
        ax.plot(x[is_changed], y[is_changed], markersize=5.0, markerfacecolor="white", **plot_style)
        if k == 0:
            guide_line = y[0] * x / x[0]
            ax.plot(x, guide_line, color=MUTED, linestyle="-", linewidth=0.8, label="∝ amplitude", zorder=1)
    for name, value in (marks or {}).items():
        mark(ax, value, name, offset=(-3, 4), width=0.9, color=MUTED, fontsize=8, rotation=90.0, ha="right")
    ax.set(xscale="log", yscale="log")
    return finish(ax, "largest initial displacement / d", "deviation from the linear motion / displacement")


@check_kinds
def measured_gains(points: Mapping[str, tuple[float, float]], *, ax: Axes | None = None) -> Axes:
    """Draw measured ratios of the flock's path size to the γ-agent's as points on a Bode magnitude plot.

    Parameters
    ----------
    points : mapping of str to (frequency, ratio)
        By label: angular frequency in radians per time unit, and measured size of the flock's path over the γ-agent's.
    """
    ax = ensure_axes(ax)
    for k, (label, (omega, ratio)) in enumerate(points.items()):
        shape = _LOOKS[k % len(_LOOKS)][1]
        height = 20.0 * np.log10(ratio)
        ax.plot(omega, height, shape, color=INK, markerfacecolor="none", markersize=7.0 + 2.5 * (k % 2), label=label)
    return finish(ax)
