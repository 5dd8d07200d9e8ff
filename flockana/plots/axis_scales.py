"""Fast drawing of the ticks, grid lines and label of one axis.

matplotlib makes five artists of every tick, and asks each six times where it stands: most of what a figure costs. Here
its own locators and formatters say where ticks stand and what their numbers are, and no artists are made of them.
"""

import re
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.transforms import Bbox, IdentityTransform

from flockana.base.value_checks import FloatArray

Size = tuple[float, float, float]  # width, height, descent
_RAISED = str.maketrans("0123456789-−", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻")
_POWER_PAD = 3.0  # points to the power of ten that numbers share
_OUTSIDE = 0.5  # pixels by which a tick may lie outside the axes, from rounding


def plain(text: str) -> str:
    r"""Return a typeset number as plain text.

    Examples
    --------
    >>> plain(r"$\mathdefault{10^{-3}}$"), plain(r"$\times\mathdefault{10^{−12}}\mathdefault{}$"), plain("0.5")
    ('10⁻³', '×10⁻¹²', '0.5')
    """
    if not text.startswith("$"):
        return text
    bare_text = text.strip("$").replace(r"\mathdefault", "").replace(r"\times", "×")
    raised_text = re.sub(r"\^\{([^{}]*)\}", lambda power: power[1].translate(_RAISED), bare_text)
    return re.sub(r"[{}$]", "", raised_text)


def _typeset(text: str) -> bool:
    """Return whether a text contains mathtext."""
    return text.count("$") > 1


@dataclass(frozen=True)
class Ticks:
    """Major or minor ticks of one axis: positions, number texts, mark sizes, and whether they have grid lines."""

    at: FloatArray  # pixels along the scale
    numbers: tuple[str, ...]  # as many; empty texts where there is none
    length: float  # length, width, pad: of the marks, and from them to the numbers: pixels, but the width in points
    width: float
    pad: float
    grid: bool  # whether grid lines go with them

    @property
    def numbered(self) -> list[tuple[float, str]]:
        """Return the positions and texts of numbered ticks."""
        return [(position, text) for position, text in zip(self.at.tolist(), self.numbers, strict=True) if text]


class PlainScale(Artist):
    """Fast replacement for matplotlib's drawing of one axis of two-dimensional axes."""

    def __init__(self, ax: Any, name: str, sizes: dict[tuple[str, float], Size]) -> None:
        super().__init__()
        self.ax, self.name, self.scale, self._known = ax, name, getattr(ax, f"{name}axis"), sizes
        self.k, tick_parameters = "xy".index(name), self.scale.get_tick_params()
        self.side = "right" if name == "y" and tick_parameters.get("right") else "left"
        self.font = FontProperties(size=tick_parameters.get("labelsize", self._style("labelsize")))
        self.set_zorder(0.5)  # below what is drawn, as the style has it
        self.scale.set_visible(False)
        ax.add_artist(self)
        self.set_clip_on(False)

    def ticks(self, which: str) -> Ticks:
        """Return the major or minor ticks of the axis that lie within its limits."""
        scale, look = self.scale, self.scale.get_tick_params(which)
        values = np.asarray(getattr(scale, f"get_{which}ticklocs")(), dtype=np.float64)
        formatter = getattr(scale, f"get_{which}_formatter")()
        tick_texts = tuple(plain(text) for text in formatter.format_ticks(values)) if values.size else ()
        points = np.zeros((values.size, 2))
        points[:, self.k] = values
        at = getattr(self.ax, f"get_{self.name}axis_transform")().transform(points)[:, self.k]
        low, high = getattr(self.ax.bbox, f"interval{self.name}")
        inside_limits = (at >= low - _OUTSIDE) & (at <= high + _OUTSIDE)
        length, width, pad = (
            float(look.get(key, self._style(f"{which}.{rc}")))
            for key, rc in (("length", "size"), ("width", "width"), ("pad", "pad"))
        )
        texts = tuple(text for text, is_inside in zip(tick_texts, inside_limits.tolist(), strict=True) if is_inside)
        return Ticks(at[inside_limits], texts, length * self._pixel, width, pad * self._pixel, bool(look["gridOn"]))

    def _style(self, key: str) -> Any:
        """Return a setting of matplotlib's style for the ticks of this axis, such as their colour."""
        plot_style: dict[str, Any] = mpl.rcParams  # type: ignore[assignment]  # its stubs take no names made here
        return plot_style[f"{self.name}tick.{key}"]

    def room(self, renderer: Any) -> tuple[float, float, float, float]:
        """Return the pixels that the axis's ticks and labels need left, right, below and above the plot."""
        kinds, ends = self._kinds(), (0.0, 0.0)
        low, high = getattr(self.ax.bbox, f"interval{self.name}")
        for position, text in (pair for ticks in kinds for pair in ticks.numbered):
            half_width = 0.5 * self._size(renderer, text)[self.k]
            ends = max(ends[0], low - position + half_width), max(ends[1], position + half_width - high)
        label, power = self.scale.get_label_text(), self._power()
        depth = self._depth(renderer, kinds)
        depth += self._label_pad() + self._label_size(renderer)[1] if label else 0.0
        extra = self._size(renderer, power)[1] + _POWER_PAD * self._pixel if power else 0.0
        if self.name == "x":
            return *ends, depth + (0.0 if label else extra), 0.0
        sides = (depth, 0.0) if self.side == "left" else (0.0, depth)
        return *sides, ends[0], max(ends[1], extra)

    def get_window_extent(self, renderer: Any = None) -> Bbox:
        """Return the extent of the axes with this scale's labels, in pixels, for matplotlib's layout."""
        left, right, bottom_margin, top_margin = self.room(renderer)
        box = self.ax.bbox
        return Bbox.from_extents(box.x0 - left, box.y0 - bottom_margin, box.x1 + right, box.y1 + top_margin)

    def _kinds(self) -> tuple[Ticks, Ticks]:
        return self.ticks("major"), self.ticks("minor")

    def _power(self) -> str:
        """Return the common power of ten of the axis's tick numbers as text, as last formatted."""
        return plain(self.scale.get_major_formatter().get_offset())

    @property
    def _pixel(self) -> float:
        return float(self.ax.figure.dpi) / 72.0

    def _label_pad(self) -> float:
        return float(self.scale.labelpad) * self._pixel

    def _size(self, renderer: Any, text: str, font: FontProperties | None = None) -> Size:
        """Return width, height and descent of a text, of a number by default (cached)."""
        font = font or self.font
        key = text, font.get_size_in_points()
        if key not in self._known:
            self._known[key] = renderer.get_text_width_height_descent(text, font, ismath=_typeset(text))
        return self._known[key]

    def _label_size(self, renderer: Any) -> Size:
        font = self.scale.label.get_fontproperties()
        _, height, descent = self._size(renderer, "lp", font)
        width, own_height, own_descent = self._size(renderer, self.scale.get_label_text(), font)
        return width, max(height, own_height), max(descent, own_descent)

    def _depth(self, renderer: Any, kinds: tuple[Ticks, ...]) -> float:
        """Return the distance in pixels from the plot's edge to the outer side of tick marks and numbers."""
        depth = 0.0
        for ticks in (ticks for ticks in kinds if ticks.at.size):
            texts = [text if self.name == "y" else "lp" for text in ticks.numbers if text]
            extents = [self._size(renderer, text)[self.name == "x"] for text in texts]
            depth = max(depth, ticks.length + (ticks.pad + max(extents) if extents else 0.0))
        return depth

    def draw(self, renderer: Any) -> None:
        """Draw grid lines, marks, numbers, their common power of ten, and the axis label."""
        kinds = self._kinds()
        for ticks in (ticks for ticks in kinds if ticks.at.size):
            self._draw_lines(renderer, ticks)
            self._draw_numbers(renderer, ticks)
        depth = self._depth(renderer, kinds)
        self._draw_power(renderer, depth)
        self._draw_label(renderer, depth)

    def _draw_lines(self, renderer: Any, ticks: Ticks) -> None:
        low, high = getattr(self.ax.bbox, f"interval{'yx'[self.k]}")
        foot, tick_direction = (high, 1.0) if self.side == "right" else (low, -1.0)
        if ticks.grid and self.side == "left":
            self._stroke(renderer, ticks.at, (low, high), mpl.rcParams["grid.color"], mpl.rcParams["grid.linewidth"])
        if ticks.length > 0.0:
            line_ends = (foot, foot + tick_direction * ticks.length)
            self._stroke(renderer, ticks.at, line_ends, self._style("color"), ticks.width)

    def _stroke(self, renderer: Any, at: FloatArray, ends: tuple[float, float], colour: str, width: float) -> None:
        """Draw parallel lines across the axis at the given places, between two ends."""
        vertices = np.empty((2 * at.size, 2))
        vertices[:, self.k] = np.repeat(at, 2)
        vertices[:, 1 - self.k] = np.tile(ends, at.size)
        codes = np.tile(np.array([Path.MOVETO, Path.LINETO], dtype=np.uint8), at.size)
        context = renderer.new_gc()
        context.set_foreground(colour)
        context.set_linewidth(width)
        context.set_capstyle("butt")
        context.set_snap(True)
        renderer.draw_path(context, Path(vertices, codes), IdentityTransform())
        context.restore()

    def _draw_numbers(self, renderer: Any, ticks: Ticks) -> None:
        box, (_, text_height, text_descent) = self.ax.bbox, self._size(renderer, "lp")
        label_distance = ticks.length + ticks.pad
        for position, text in ticks.numbered:
            width, height, descent = self._size(renderer, text)
            if self.name == "x":
                x, y = position - 0.5 * width, box.y0 - label_distance - (text_height - text_descent)
            else:
                x = box.x0 - label_distance - width if self.side == "left" else box.x1 + label_distance
                y = position - 0.5 * (height - descent)
            self._write(renderer, x, y, text)

    def _draw_power(self, renderer: Any, depth: float) -> None:
        text = self._power()
        if not text:
            return
        box, (width, height, descent) = self.ax.bbox, self._size(renderer, text)
        if self.name == "x":
            x, y = box.x1 - width, box.y0 - depth - _POWER_PAD * self._pixel - (height - descent)
        else:
            x, y = box.x0 if self.side == "left" else box.x1, box.y1 + _POWER_PAD * self._pixel + descent
        self._write(renderer, x, y, text)

    def _draw_label(self, renderer: Any, depth: float) -> None:
        label, box = self.scale.label, self.ax.bbox
        if not label.get_text():
            return
        width, height, descent = self._label_size(renderer)
        label_distance = depth + self._label_pad()
        if self.name == "x":
            x, y, angle = 0.5 * (box.x0 + box.x1 - width), box.y0 - label_distance - (height - descent), 0.0
        else:
            x = box.x0 - label_distance - descent if self.side == "left" else box.x1 + label_distance + height - descent
            y, angle = 0.5 * (box.y0 + box.y1 - width), 90.0
        self._write(renderer, x, y, label.get_text(), (label.get_fontproperties(), label.get_color(), angle))

    def _write(self, renderer: Any, x: float, y: float, text: str, look: tuple[Any, str, float] | None = None) -> None:
        """Draw a text with its lower left corner at (x, y), by default in the style of tick numbers."""
        font, colour, angle = look or (self.font, self._style("color"), 0.0)
        context = renderer.new_gc()
        context.set_foreground(colour)
        height = renderer.get_canvas_width_height()[1]
        renderer.draw_text(context, x, height - y if renderer.flipy() else y, text, font, angle, ismath=_typeset(text))
        context.restore()


def plain_scales(figure: Any) -> dict[Any, tuple[PlainScale, ...]]:
    """Install fast scales on all two-dimensional axes of a figure, colour bars included; return them by axes."""
    flat_axes = (ax for outer in figure.axes for ax in (outer, *outer.child_axes) if ax.name == "rectilinear")
    text_sizes: dict[tuple[str, float], Size] = {}
    return {ax: tuple(PlainScale(ax, name, text_sizes) for name in "xy") for ax in flat_axes}
