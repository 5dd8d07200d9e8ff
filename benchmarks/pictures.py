"""The two pictures of the page: cost against n, and work against precision."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from math import isfinite
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

LINES = (("an evaluation", "flow", "o"), ("a step of RK4", "step", "s"), ("a short run of DOP853", "adaptive", "^"))
MARKERS = "os^Dv*P"

Series = Sequence[Mapping[str, Any]]


def draw(series: Mapping[str, Series], folder: Path) -> list[Path]:
    """Write a PNG for each series that is known and there; returns the paths."""
    drawn = []
    for name, figure in (("cost", _cost), ("work-precision", _work_precision)):
        if series.get(name):
            path = folder / f"performance-{name}.png"
            canvas = FigureCanvasAgg(figure(series[name]))
            canvas.print_png(path, metadata={"Software": None})
            drawn.append(path)
    return drawn


def _cost(points: Series) -> Figure:
    """CPU time and peak memory of an evaluation and of a step, each against n."""
    figure = Figure(figsize=(9.0, 3.6), dpi=110, layout="tight")
    left, right = figure.subplots(1, 2)
    n = [point["n"] for point in points]
    for label, key, marker in LINES:
        left.plot(n, [point[key] for point in points], marker=marker, label=label)
        right.plot(n, [max(point[f"{key}_memory"], 0.01) for point in points], marker=marker, label=label)
    left.plot(n, [points[-1]["flow"] * k / n[-1] for k in n], color="0.7", linestyle=":", label="proportional to n")
    _finish(left, "agents", "CPU time, s")
    _finish(right, "agents", "growth of peak memory, MB")
    return figure


def _work_precision(points: Series) -> Figure:
    """CPU time against the error that was reached, a line for each method."""
    figure = Figure(figsize=(6.0, 4.2), dpi=110, layout="tight")
    axes = figure.subplots()
    known = list(dict.fromkeys(str(point["method"]).removeprefix("scipy-") for point in points))
    for method, group in groupby(points, key=lambda point: str(point["method"])):
        reached = [point for point in group if isfinite(point["error"])]
        own = method.removeprefix("scipy-")  # scipy's stepping of the same method looks alike, dashed
        look = {"marker": MARKERS[known.index(own) % len(MARKERS)], "color": f"C{known.index(own)}", "label": method}
        style = "-" if method == own else "--"
        axes.plot([p["error"] for p in reached], [p["seconds"] for p in reached], style, **look)
    axes.invert_xaxis()
    _finish(axes, "farthest off, in units of d", "CPU time, s")
    axes.set_title("Fig. 10: 150 agents, 60 time units", fontsize=10)
    return figure


def _finish(axes: Axes, x: str, y: str) -> None:
    axes.set(xscale="log", yscale="log", xlabel=x, ylabel=y)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
