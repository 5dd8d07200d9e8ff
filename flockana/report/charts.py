"""Time-series charts as SVG text in the page's own colours, a hundred times faster than drawn figures."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from math import ceil, floor, log10
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray

_WIDTH, _HEIGHT = 720, 380  # whole numbers of this drawing are half a pixel of the page
_LEFT, _RIGHT, _TOP, _BELOW = 112, 20, 24, 60
_SPANS = 70  # of time, in each of which a curve is drawn through its least and greatest value
_DECADES = 6  # more of them are labelled at every other one


@dataclass(frozen=True)
class Curve:
    """Curve of a chart: values over the chart's times, with a label."""

    values: FloatArray  # shape (T,): over the chart's times; where they are not finite there is no curve
    label: str = ""  # what it is; empty if the chart's own words say it


@dataclass(frozen=True)
class Chart:
    """Time-series chart: curves over the same times, axis text, scale, and horizontal lines with names."""

    words: str  # what the axis upwards is
    t: FloatArray  # shape (T,): times
    curves: Sequence[Curve]  # at most five: they differ in colour and dash
    logarithmic: bool = False  # whether decades are equally long; what is not positive is then left out
    levels: Sequence[tuple[float, str]] = ()  # horizontal lines, with their names

    def svg(self) -> str:
        """Return the chart as an ``<svg>`` element."""
        curves = [np.asarray(curve.values, dtype=np.float64) for curve in self.curves]
        logarithmic = self.logarithmic and any((values > 0.0).any() for values in curves)
        low, high = _limits([*curves, np.array([level for level, _ in self.levels])], logarithmic)
        t0, t1 = float(self.t[0]), float(self.t[-1])
        width, height = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BELOW

        def x(time: Any) -> Any:
            return _LEFT + width * (time - t0) / ((t1 - t0) or 1.0)

        def y(value: Any) -> Any:
            return _TOP + height * (1.0 - (value - low) / (high - low))

        ticks = _decades(low, high) if logarithmic else _round(low, high, 4)
        parts = [f'<path class="grid" d="{"".join(f"M{_LEFT} {y(at):.0f}H{_WIDTH - _RIGHT}" for at, _ in ticks)}"/>']
        parts += [f'<text x="{_LEFT - 10}" y="{y(at) + 7:.0f}">{text}</text>' for at, text in ticks]
        times = "".join(f'<text x="{x(at):.0f}" y="{_HEIGHT - 30}">{text}</text>' for at, text in _round(t0, t1, 5))
        parts.append(f'<g class="times">{times}</g>')
        parts.append(f'<text x="{_WIDTH - _RIGHT}" y="{_HEIGHT - 4}">t (time)</text>')
        for level, name in self.levels:
            if not logarithmic or level > 0.0:
                at = y(log10(level) if logarithmic else level)
                parts.append(f'<path class="level" d="M{_LEFT} {at:.0f}H{_WIDTH - _RIGHT}"/>')
                parts.append(f'<text x="{_WIDTH - _RIGHT}" y="{at - 6:.0f}">{escape(name)}</text>')
        for k, values in enumerate(curves):
            kept_samples = _kept(values)
            with np.errstate(divide="ignore", invalid="ignore"):
                heights = np.log10(values[kept_samples]) if logarithmic else values[kept_samples]
            path = _path(np.asarray(x(self.t[kept_samples])), np.asarray(y(heights)))
            parts.append(f'<path class="curve c{k}" d="{path}"/>')
        words = escape(self.words, quote=True)
        head = f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" aria-label="{words} over time">'
        label_rows = [(k, curve.label) for k, curve in enumerate(self.curves) if curve.label]
        keys = "".join(f'<span><i class="key c{k}"></i>{escape(label)}</span>' for k, label in label_rows)
        legend = f'<p class="legend">{keys}</p>' if keys else ""
        return f'<div class="chart"><p class="axis">{words}</p>{head}{"".join(parts)}</svg>{legend}</div>'


def panels(charts: Sequence[Chart]) -> str:
    """Return charts side by side, as HTML."""
    return f'<div class="panels">{"".join(chart.svg() for chart in charts)}</div>'


def _kept(values: FloatArray) -> npt.NDArray[np.intp]:
    """Return indices of samples that represent a curve: both ends, least and greatest in each interval."""
    samples = len(values)
    if samples <= 2 * _SPANS:
        return np.arange(samples)
    edges = np.linspace(0, samples, _SPANS + 1).astype(int)
    corners, finite_values = {0, samples - 1}, np.nan_to_num(values)
    for first_index, chunk_stop in pairwise(edges.tolist()):
        chunk_values = finite_values[first_index:chunk_stop]
        corners |= {int(first_index + chunk_values.argmin()), int(first_index + chunk_values.argmax())}
    return np.array(sorted(corners))


def _limits(values: Sequence[FloatArray], logarithmic: bool) -> tuple[float, float]:
    all_values = np.concatenate(values)
    all_values = all_values[np.isfinite(all_values) & ((all_values > 0.0) | (not logarithmic))]
    if not all_values.size:
        return 0.0, 1.0
    if logarithmic:
        low, high = floor(log10(all_values.min()) * 2.0) / 2.0, ceil(log10(all_values.max()) * 2.0) / 2.0
        return low, high if high > low else low + 1.0
    low, high = float(all_values.min()), float(all_values.max())
    if 0.0 < low < 0.5 * high:
        low = 0.0
    margin = 0.04 * (high - low) or 0.5 * abs(high) or 0.5
    return low - margin * (low != 0.0), high + margin


def _round(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """Return round tick values in an interval, with their texts."""
    if not high > low:
        return [(low, f"{low:.4g}")]
    rough_step = (high - low) / most
    power = 10.0 ** floor(log10(rough_step))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough_step * (1.0 - 1e-9))
    ticks = [k * step + 0.0 for k in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1)]
    largest = max(map(abs, ticks), default=0.0)
    if largest and not 1e-3 <= largest < 1e5:
        digits = floor(log10(largest / step) + 1e-9) + 2
        return [(position, f"{position:.{digits}g}") for position in ticks]
    decimals = max(0, -floor(log10(step) + 1e-9))
    return [(position, f"{position:.{decimals}f}") for position in ticks]


def _decades(low: float, high: float) -> list[tuple[float, str]]:
    stride = 1 + int((high - low) // _DECADES)
    return [(float(k), f"1e{k}") for k in range(ceil(low), floor(high) + 1) if k % stride == 0]


def _path(x: FloatArray, y: FloatArray) -> str:
    """Return points as SVG path data in whole numbers, broken at non-finite points."""
    text: list[str] = []
    heights = [round(v) if np.isfinite(v) else None for v in y.tolist()]
    pen = "M"
    for k, (u, v) in enumerate(zip(x.tolist(), heights, strict=True)):
        if v is None:
            pen = "M"
            continue
        if pen == "L" and 0 < k < len(heights) - 1 and heights[k - 1] == v == heights[k + 1]:
            continue
        text.append(f"{pen}{u:.0f} {v}")
        pen = "L"
    return "".join(text)
