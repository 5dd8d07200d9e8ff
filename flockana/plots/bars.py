"""Bar charts of tables: loop margins, standard deviations in noise, predicted and measured."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_finite_scalar
from flockana.plots.palette import BLUE, INK, MUTED, VERMILLION
from flockana.plots.style import finish, subplots

Cell = float | tuple[float, float]
_HEIGHT = 0.6  # of a bar


@check_kinds
def bars(
    table: Mapping[str, Mapping[str, Cell]], *, limits: Mapping[str, float] | None = None, ax: Any = None
) -> npt.NDArray[Any]:
    """Draw a table of numbers as horizontal bars, a panel for each column.

    Parameters
    ----------
    table : mapping of str to mapping of str to float or (float, float)
        Values by row and column, such as `RobustnessMargins.table`; a pair is a value and half the width of its
        interval. An infinite value has a bar across the panel and the sign ∞.
    limits : mapping of str to float, optional
        By column, what is asked or predicted: a line.
    ax : sequence of Axes, optional
        One for each column; by default a new figure.

    Returns
    -------
    ndarray of matplotlib.axes.Axes

    Examples
    --------
    >>> panels = bars({"agent 0": {"phase (degrees)": 34.0}, "agent 1": {"phase (degrees)": (51.0, 2.0)}})
    >>> [label.get_text() for label in panels[0].get_yticklabels()]
    ['agent 0', 'agent 1']
    """
    if not table:
        raise ArgumentError("table is empty: expected numbers by row and column")
    columns = list(next(iter(table.values())))
    for row, cells in table.items():
        if not columns or list(cells) != columns:
            raise ArgumentError(f"row {row!r} has the columns {list(cells)}: expected {columns}, as the first has")
    height = 1.0 + 0.3 * len(table)
    panels = np.ravel(subplots(1, len(columns), size=(2.6 * len(columns), height))[1] if ax is None else ax)
    bar_positions = -np.arange(len(table))
    for column, panel in zip(columns, panels, strict=True):
        pairs = [_cell(f"{row}, {column}", cells[column]) for row, cells in table.items()]
        values, widths = np.array(pairs).T
        is_finite = np.isfinite(values)
        bar_lengths = np.where(is_finite, values, 1.2 * max(values[is_finite], default=1.0))
        panel.barh(bar_positions, bar_lengths, _HEIGHT, color=[BLUE if item else MUTED for item in is_finite])
        panel.errorbar(values, bar_positions, xerr=widths, fmt="none", ecolor=INK, capsize=2.0)
        for marker_position in bar_positions[~is_finite]:
            panel.annotate("∞", (0.0, marker_position), xytext=(4.0, 0.0), textcoords="offset points", va="center")
        if column in (limits or {}):
            panel.axvline((limits or {})[column], color=VERMILLION, linestyle="--", linewidth=1.2)
        panel.set_yticks(bar_positions, list(table) if panel is panels[0] else [""] * len(table))
        finish(panel, column)
    return panels


def _cell(name: str, cell: Any) -> tuple[float, float]:
    value, width = cell if isinstance(cell, tuple) else (cell, 0.0)
    if value == np.inf:
        return np.inf, 0.0
    return ensure_finite_scalar(name, value), ensure_finite_scalar(f"half width of {name}", width)
