"""Reynolds' three rules on a flock: stresses of links, and the force of each rule on every agent."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_points
from flockana.measures.reynolds import Reynolds
from flockana.plots.palette import BLUE, FAINT, GREEN, INK, VERMILLION
from flockana.plots.style import ensure_axes, finish, frame_space

_ARROW = 0.1  # longest arrow as a share of the axes' width


@check_kinds
def rules(parts: Reynolds, q: Any, *, ax: Axes | None = None) -> Axes:
    """Draw links by the sign of their stress, and the three parts of u as arrows on one scale.

    Parameters
    ----------
    parts : Reynolds
        What `flockana.measures.reynolds.reynolds` found.
    q : array_like, shape (n, 2)
        The positions that it was given.
    """
    points = ensure_points("q", q)
    if points.shape != parts.total.shape or points.shape[1] != 2:
        raise ArgumentError(f"q of shape {points.shape}, rules of shape {parts.total.shape}: expected (n, 2) of both")
    axes = ensure_axes(ax)
    signs = (parts.stress > 0.0, parts.stress < 0.0, parts.stress == 0.0)
    styles = ((BLUE, "-", "F⁺, pulls"), (VERMILLION, "--", "F⁻, pushes"), (FAINT, ":", "F⁰"))
    for sign, (colour, dash, name) in zip(signs, styles, strict=True):
        if sign.any():
            lines = points[parts.links[sign]]
            axes.add_collection(LineCollection(lines, colors=colour, linestyles=dash, linewidths=0.8, label=name))
    axes.scatter(*points.T, s=12, color=INK, linewidths=0, zorder=3)
    names = "flock centring", "collision avoidance", "velocity matching"
    forces = parts.centring, parts.avoidance, parts.matching
    longest = max(float(np.linalg.norm(rule_forces, axis=1).max()) for rule_forces in forces)
    scale = {"angles": "xy", "scale_units": "width", "scale": longest / _ARROW, "width": 0.004, "zorder": 4}
    for name, rule_forces, colour in zip(names, forces, (BLUE, VERMILLION, GREEN), strict=True):
        is_acting = np.linalg.norm(rule_forces, axis=1) > 1e-3 * longest
        if is_acting.any():
            axes.quiver(*points[is_acting].T, *rule_forces[is_acting].T, color=colour, label=name, **scale)
    text = f"longest arrow: {longest:.3g} length/time²" if longest > 0.0 else "no rule acts"
    axes.margins(0.12)
    finish(axes)
    axes.get_legend().set_title(text, prop={"size": 8})
    return frame_space(axes, points, 2)
