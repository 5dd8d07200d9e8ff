"""Figure style as a context, without changes to matplotlib's global settings."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import update_wrapper
from inspect import signature
from textwrap import wrap
from typing import Any, Protocol

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection  # type: ignore[import-untyped]

from flockana.base.value_checks import FloatArray, ensure_count
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.plots.palette import BLUE, GREEN, INK, MUTED, PURPLE, VERMILLION
from flockana.plots.paper_figures import column_size
from flockana.plots.symbol_typesetting import typeset

_STYLE = {
    "axes.prop_cycle": cycler(color=[BLUE, VERMILLION, GREEN, PURPLE, INK])
    + cycler(linestyle=["-", "--", "-.", ":", "-"]),
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": MUTED,
    "axes.labelcolor": INK,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.labelsize": 9,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.limits": (-3, 5),
    "axes.formatter.use_mathtext": True,
    "grid.color": "#ececec",
    "grid.linewidth": 0.7,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "lines.linewidth": 1.4,
    "legend.fontsize": 8,
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "font.size": 9,
    "svg.hashsalt": "flockana",
    "pdf.fonttype": 42,  # TrueType: publishers refuse Type 3
    "ps.fonttype": 42,
}


LEGEND: dict[str, Any] = {"fontsize": 8, "framealpha": 0.85, "edgecolor": "none"}  # wherever the axes were made
ABOVE: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.2}


@contextmanager
def style() -> Iterator[None]:
    """Apply flockana's style inside a ``with`` block, and restore the settings after it.

    Examples
    --------
    >>> import matplotlib
    >>> with style():
    ...     inside = matplotlib.rcParams["axes.spines.top"]
    >>> inside, matplotlib.rcParams["axes.spines.top"]
    (False, True)
    """
    interactive = mpl.is_interactive()
    try:
        with mpl.rc_context(_STYLE):  # type: ignore[arg-type]  # the stubs know each key's type, a plain dict does not
            try:
                yield
            finally:
                interactive = mpl.is_interactive()
    finally:  # a notebook's backend, if it is loaded here first, would leave this on
        mpl.interactive(interactive)


_WIDER = 1.15  # than the axes may a legend be, for the names of their ticks stand beside them
_MOST_LINES = 2  # of a label
_EM = 0.55  # width of a letter, over its size


def ensure_axes(ax: Any, *, m: int = 2) -> Any:
    """Return `ax`, or new axes in flockana's style: flat ones, or three-dimensional ones for m = 3."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    with style():
        figure = plt.figure(figsize=(5.2, 4.2))
        return figure.add_subplot(projection="3d" if m == 3 else None)


def subplots(
    rows: int = 1, columns: int = 1, *, size: tuple[float, float] | str | None = None, m: int = 2
) -> tuple[Any, Any]:
    """Return a new figure in flockana's style, as ``pyplot.subplots``: (figure, Axes or array of Axes).

    Parameters
    ----------
    rows, columns : int
        Of the grid.
    size : (float, float) or str, optional
        Width and height in inches, or a journal's column by its name in `flockana.plots.paper_figures.COLUMNS`, such as
        ``"ieee"``; by default 4.4 by 3.4 for each Axes.
    m : int
        Dimension of what will be drawn: 3 for three-dimensional axes.

    Examples
    --------
    >>> figure, axes = subplots(1, 2)
    >>> axes.shape, figure.get_size_inches().tolist()
    ((2,), [8.8, 3.4])
    """
    import matplotlib.pyplot as plt

    rows, columns = ensure_count("rows", rows), ensure_count("columns", columns)
    with style():
        kind = {"projection": "3d"} if m == 3 else {}
        inches = column_size(size, rows, columns) if isinstance(size, str) else size or (4.4 * columns, 3.4 * rows)
        return plt.subplots(rows, columns, figsize=inches, subplot_kw=kind)


def finish(ax: Any, x: str = "", y: str = "") -> Axes:
    """Label the axes, add a legend above them if there are labels, and return the axes."""
    if x:
        ax.set_xlabel(typeset(x))
    if y:
        letters = ax.get_window_extent().height / ax.figure.dpi * 72.0 / (_EM * ax.yaxis.label.get_size())
        column_width = max(int(1.1 * letters), 12)
        lines = [y] if "$" in y else wrap(y, column_width, break_long_words=False)
        if len(lines) > _MOST_LINES and "," in y:  # the symbol and its unit alone
            unit = y.rpartition(" (")
            lines = [y.partition(",")[0] + (f" ({unit[2]}" if unit[1] else "")]
        ax.set_ylabel("\n".join(map(typeset, lines)))
    if ax.get_legend_handles_labels()[0]:
        place_legend(ax)
    return ax


def finish_over_time(ax: Any, t: FloatArray, y: str) -> Axes:
    """Label axes over time, limited to the first and last time, and return them."""
    if len(t) > 1:
        ax.set_xlim(t[0], t[-1])
    return finish(ax, "t (time)", y)


class OverTime(Protocol):
    """Plot function of a run over time."""

    def __call__(self, trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
        """Draw a run over time on the given axes, or on new ones."""


def over_time(label: str) -> Callable[[Callable[[Trajectory, Any], str | None]], OverTime]:
    """Decorate a function that draws a run or returns a reason for an empty plot: label and finish the axes."""

    def decorated(draw: Callable[[Trajectory, Any], str | None]) -> OverTime:
        def plot(trajectory: Trajectory, *, ax: Axes | None = None) -> Axes:
            ensure_run(trajectory)
            axes = ensure_axes(ax)
            if reason := draw(trajectory, axes):
                return finish_empty(axes, label, reason)
            return finish_over_time(axes, trajectory.t, label)

        plot.__signature__ = signature(plot)  # type: ignore[attr-defined]  # not that of `draw`
        return update_wrapper(plot, draw, ("__module__", "__name__", "__qualname__", "__doc__"))

    return decorated


def curves(ax: Any, t: FloatArray, styles: Iterable[tuple[FloatArray, str, str, str]], *, width: float = 1.4) -> None:
    """Draw a line for each (values, label, colour, dash)."""
    for values, label, colour, dash in styles:
        ax.plot(t, values, color=colour, linestyle=dash, linewidth=width, label=label)


def levels(ax: Any, styles: Iterable[tuple[float, str, str, str]]) -> None:
    """Draw a horizontal line for each (value, label, colour, dash)."""
    for value, label, colour, dash in styles:
        ax.axhline(value, color=colour, linestyle=dash, linewidth=1.1, label=label)


def mark(
    ax: Any, x: float, name: str = "", *, offset: tuple[float, float] = (3, 4), height: float = 0.0, **look: Any
) -> None:
    """Draw a dotted line at x with its name beside the line at a given height; `width` is the line width."""
    ax.axvline(x, color=MUTED, linewidth=look.pop("width", 0.8), linestyle=":")
    if name:
        look |= {"xycoords": ax.get_xaxis_transform(), "textcoords": "offset points"}
        ax.annotate(typeset(name), (x, height), offset, **look)


def finish_empty(ax: Any, y: str, reason: str) -> Axes:
    """Show a reason in the middle of empty axes, and return them."""
    ax.set_xticks([])
    ax.set_yticks([])
    ax.text(0.5, 0.5, typeset(reason), ha="center", va="center", transform=ax.transAxes, color=MUTED)
    return finish(ax, y=y)


def write_title(ax: Any, title: str, **look: Any) -> None:
    """Write the title at the left above the axes."""
    look = {"fontsize": _STYLE["axes.titlesize"], "color": INK} | look
    ax.set_title(typeset(title), loc="left", **look)


def place_legend(ax: Any) -> None:
    """Put the legend above the axes, in as many columns as fit their width."""
    handles, labels = ax.get_legend_handles_labels()
    plot_style = LEGEND | ABOVE | {"handlelength": 1.8, "columnspacing": 1.2}
    for columns in range(min(len(handles), 3 if len(handles) in (3, 5, 6) else 4), 0, -1):
        legend = ax.legend(handles, [typeset(label) for label in labels], ncols=columns, **plot_style)
        if columns == 1 or legend.get_window_extent().width <= _WIDER * ax.get_window_extent().width:
            return


def colour_bar(ax: Any, colours: Any, label: str, *, extend: str = "neither", share: float = 0.75) -> Any:
    """Add a colour bar to the right of axes, as a part of them."""
    bar_axes = ax.inset_axes((1.03, 0.5 - 0.5 * share, 0.03, share))
    scale = ax.get_figure().colorbar(colours, cax=bar_axes, extend=extend, label=typeset(label))
    scale.outline.set_visible(False)
    bar_axes.tick_params(labelsize=_STYLE["ytick.labelsize"], colors=MUTED)
    bar_axes.yaxis.label.set(size=_STYLE["axes.labelsize"], color=INK)
    return scale


def star(ax: Any, places: FloatArray, **look: Any) -> None:
    """Draw targets or leaders as stars."""
    look = {"s": 110, "color": VERMILLION, "zorder": 4} | look
    ax.scatter(*places.T, marker="*", edgecolors="white", linewidths=0.6, **look)


def hairlines(ax: Any, x: Any, values: FloatArray, label: str, *, colour: str = BLUE, crowd: int = 1) -> None:
    """Draw a faint line for each column, fainter for more lines, with one legend entry."""
    width, alpha = line_width_and_opacity(crowd * max(1, values.shape[1]))
    ax.plot(x, values, color=colour, linestyle="-", linewidth=width, alpha=alpha)
    ax.plot([], [], color=colour, linestyle="-", linewidth=0.8, label=label)


def line_width_and_opacity(n: int) -> tuple[float, float]:
    """Return width and opacity of one of n lines on the same axes; fainter for more lines."""
    return min(max(20.0 / n, 0.4), 1.2), min(max(20.0 / n, 0.4), 0.9)


def in_plane(points: FloatArray) -> FloatArray:
    """Return points in the plane; points on a line get y = 0."""
    return np.column_stack([points, np.zeros(len(points))]) if points.shape[1] == 1 else points


def lines(segments: Any, **look: Any) -> Any:
    """Return a collection of lines in the plane or in space, from arrays of their points."""
    return (Line3DCollection if np.shape(segments)[-1] == 3 else LineCollection)(segments, **look)


def frame_space(ax: Any, points: FloatArray, m: int) -> Axes:
    """Label the axes of space and scale them equally."""
    ax.set(**{f"{name}label": typeset(f"{name} (length)") for name in "xyz"[:m]})
    if m == 1:
        ax.set(yticks=[], ylim=(-1.0, 1.0))
    elif m == 2:
        ax.set_aspect("equal", adjustable="datalim")
    else:
        # a cube, with room for the labels, which the layout does not measure
        ax.set_box_aspect((1.0, 1.0, 1.0), zoom=0.82)
        low, high = points.min(axis=0), points.max(axis=0)
        midpoint, half_width = 0.5 * (low + high), 0.53 * float((high - low).max()) or 1.0
        limit(ax, midpoint - half_width, midpoint + half_width)
        for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
            axis.set_major_locator(MaxNLocator(4))
    return ax


def limit(ax: Any, low: FloatArray, high: FloatArray) -> None:
    """Limit axes of the plane or of space to a box."""
    ax.set(**{f"{name}lim": ends for name, *ends in zip("xyz", low.tolist(), high.tolist(), strict=False)})
