"""Layout of a figure's axes, from the measured sizes of their texts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.text import Text

from flockana.base.checks import FloatArray
from flockana.plots.scales import PlainScale

_AROUND = (0.62, 0.12, 0.46, 0.3)  # inches left, right, below, above axes, before they are measured
_ROUNDS = 4  # at most; two but where a legend is wider than its axes
_PAD = 0.05  # inches between what axes carry

Scales = dict[Any, tuple[PlainScale, ...]]


@dataclass(frozen=True)
class _Place:
    """Axes with their columns and rows in the figure's grid."""

    ax: Any
    columns: tuple[int, int]
    rows: tuple[int, int]
    widths: FloatArray
    heights: FloatArray


def place_axes(figure: Any, renderer: Any, scales: Scales) -> None:
    """Place the axes of a grid in the room that their texts leave, by the grid's ratios.

    They are measured where usual margins would put them, then where that puts them, until that is room enough:
    numbers depend on the size of axes, and what a wide legend takes beside them does.
    """
    places = [_place(ax) for ax in figure.axes]
    if not places:
        return
    size = np.asarray(figure.get_size_inches(), dtype=np.float64)
    _set_positions(places, np.tile(_AROUND, (len(places), 1)), size)
    around = np.zeros((len(places), len(_AROUND)))
    for _ in range(_ROUNDS):
        measured = np.array([_around(place.ax, renderer, scales) for place in places])
        if (measured <= around + 0.5 * _PAD).all():
            return
        around = np.maximum(around, measured)  # never less: fewer numbers make room for more
        _set_positions(places, around, size)


def _place(ax: Any) -> _Place:
    spec = ax.get_subplotspec()
    grid = spec.get_gridspec()
    widths = np.asarray(grid.get_width_ratios(), dtype=np.float64)
    heights = np.asarray(grid.get_height_ratios(), dtype=np.float64)
    columns, rows = (spec.colspan.start, spec.colspan.stop - 1), (spec.rowspan.start, spec.rowspan.stop - 1)
    return _Place(ax, columns, rows, widths, heights)


def _around(ax: Any, renderer: Any, scales: Scales) -> tuple[float, ...]:
    """Return the inches that numbers, names, title, legend and colour bar take on each side."""
    figure = ax.get_figure()
    inner = ax.get_position(original=True).transformed(figure.transFigure)
    ax.apply_aspect()
    boxes = [_extents(ax, renderer, scales)]
    for bar in ax.child_axes:
        bar.apply_aspect(bar.get_axes_locator()(bar, renderer))
        boxes.append(_extents(bar, renderer, scales))
    outer = np.array(boxes)
    (left, _, low, _), (_, right, _, high) = outer.min(axis=0), outer.max(axis=0)
    sides = inner.x0 - left, right - inner.x1, inner.y0 - low, high - inner.y1
    return tuple(max(float(side), 0.0) / figure.dpi for side in sides)


def _extents(ax: Any, renderer: Any, scales: Scales) -> tuple[float, ...]:
    """Return the extents of axes with their texts, in pixels; a title may extend to the right."""
    if ax not in scales:  # axes of space
        box = ax.get_tightbbox(renderer, for_layout_only=True)
        return box.x0, box.x1, box.y0, box.y1
    box, rooms = ax.bbox, np.max([scale.room(renderer) for scale in scales[ax]], axis=0)
    left, right, low, high = box.x0 - rooms[0], box.x1 + rooms[1], box.y0 - rooms[2], box.y1 + rooms[3]
    texts = [text for text in ax.texts if text.get_in_layout() and not text.get_clip_on()]
    for artist in (*texts, *([legend] if (legend := ax.get_legend()) else [])):
        extent = artist.get_window_extent(renderer)
        left, right = min(left, extent.x0), max(right, extent.x1)
        low, high = min(low, extent.y0), max(high, extent.y1)
    for title in (text for text in ax.get_children() if isinstance(text, Text) and text not in ax.texts):
        if not title.get_text():
            continue
        title.set_y(1.0 + rooms[3] / box.height)  # above what else is there
        high = max(high, title.get_window_extent(renderer).y1)
    return left, right, low, high


def _set_positions(places: list[_Place], around: FloatArray, size: FloatArray) -> None:
    """Set positions: along each direction the largest margins at each line of the grid, the rest to the axes."""
    both = list(zip(places, around.tolist(), strict=True))
    across = _intervals([(p.columns, left, right) for p, (left, right, *_) in both], places[0].widths, size[0])
    down = _intervals([(p.rows, top, bottom) for p, (*_, bottom, top) in both], places[0].heights, size[1])
    for place, (left, right), (top, bottom) in zip(places, across, down, strict=True):
        place.ax.set_position((left, 1.0 - bottom, right - left, bottom - top), which="original")


def _intervals(
    wanted: list[tuple[tuple[int, int], float, float]], ratios: FloatArray, length: float
) -> list[tuple[float, float]]:
    """Return where axes begin and end along one direction, as shares of the figure's length.

    Examples
    --------
    >>> _intervals([((0, 0), 1.0 - _PAD, 0.0), ((1, 1), 0.0, 1.0 - _PAD)], np.ones(2), 4.1)[0][0] * 4.1
    1.0
    """
    before, after = np.zeros(len(ratios)), np.zeros(len(ratios))
    for (first, last), left, right in wanted:
        before[first], after[last] = max(before[first], left), max(after[last], right)
    before, after = before + _PAD, after + _PAD
    room = max(length - float((before + after).sum()), 0.1 * length)
    widths = room * ratios / ratios.sum()
    ends = np.cumsum(before + widths + after) - after
    starts = ends - widths
    return [(float(starts[first] / length), float(ends[last] / length)) for (first, last), *_ in wanted]
