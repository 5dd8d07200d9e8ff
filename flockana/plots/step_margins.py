"""Ratios of the largest stable steps to the steps in use."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_positive
from flockana.plots.palette import BLUE, INK, VERMILLION
from flockana.plots.style import ensure_axes, finish

_HEIGHT, _HATCH = 0.6, "///"  # height of a bar; hatch of an unstable one, visible in grey


@check_kinds
def step_margins(steps: Mapping[str, tuple[float, float]], *, ax: Axes | None = None) -> Axes:
    """Draw the ratio of the largest stable step to the step in use, on a logarithmic axis; unstable steps hatched.

    Parameters
    ----------
    steps : mapping of str to (float, float)
        By name, the largest stable step and the step in use, such as ``(margin.period, dt)`` of a `SamplingMargin`.
    """
    if not steps:
        raise ArgumentError("steps is empty: expected (largest stable step, step in use) by name")
    pairs = [(ensure_positive(f"{k}: margin", a), ensure_positive(f"{k}: dt", b)) for k, (a, b) in steps.items()]
    ratios = [largest / step_used for largest, step_used in pairs]
    axes, places = ensure_axes(ax), -np.arange(len(ratios))
    for place, ratio in zip(places, ratios, strict=True):
        stable = ratio > 1.0
        look = {"color": BLUE} if stable else {"color": "none", "edgecolor": VERMILLION, "hatch": _HATCH}
        axes.barh(place, ratio - 1.0, _HEIGHT, left=1.0, **look)
        where = {"ha": "left", "xytext": (4.0, 0.0)} if stable else {"ha": "right", "xytext": (-4.0, 0.0)}
        axes.annotate(f"{ratio:.3g}", (ratio, place), textcoords="offset points", va="center", fontsize=8.0, **where)
    axes.axvline(1.0, color=INK, linewidth=1.0)
    axes.set_xscale("log")
    ticks: dict[str, Any] = {"major_locator": LogLocator(subs=(1.0, 2.0, 5.0)), "major_formatter": "{x:g}"}
    axes.xaxis.set(minor_formatter=NullFormatter(), **ticks)
    axes.set_xlim(min(0.4, 0.6 * min(ratios)), 1.8 * max(2.0, *ratios))
    axes.set_yticks(places, list(steps))
    return finish(axes, "largest stable step over the step in use")
