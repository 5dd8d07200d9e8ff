"""Figures for a paper: column widths of journals, and fonts that publishers accept."""

import os
from pathlib import Path
from typing import Any

import matplotlib as mpl

from flockana.base.errors import ArgumentError, format_value
from flockana.base.files import ensure_path
from flockana.base.value_checks import ensure_known

COLUMNS = {  # widths in inches
    "ieee": 3.5,
    "ieee-wide": 7.16,
    "elsevier": 3.54,
    "elsevier-middle": 5.51,
    "elsevier-wide": 7.48,
}
_SHAPE = 0.75  # height over width of each Axes


def column_size(name: str, rows: int = 1, columns: int = 1) -> tuple[float, float]:
    """Return width and height in inches of a figure that fills a journal's column."""
    ensure_known("column", name, COLUMNS)
    width = COLUMNS[name]
    return width, round(_SHAPE * width * rows / columns, 3)


def save(drawing: Any, path: str | os.PathLike[str], *, column: str = "") -> Path:
    """Write a figure, or that of some Axes, with TrueType fonts (Type 42) in PDF and EPS.

    Parameters
    ----------
    drawing : Figure or Axes
        What to write.
    path : path-like
        File whose ending names the format, such as ``.pdf``.
    column : str
        A journal's column to fit the width to, one of `COLUMNS`.

    Examples
    --------
    >>> import tempfile, matplotlib.figure
    >>> figure = matplotlib.figure.Figure()
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(figure, folder + "/empty.pdf", column="ieee").name, float(figure.get_figwidth())
    ('empty.pdf', 3.5)
    """
    target = ensure_path(path, action="write")
    if not hasattr(drawing, "get_figure"):
        raise ArgumentError(f"drawing = {format_value(drawing)}: expected a figure or Axes of matplotlib")
    figure = drawing if hasattr(drawing, "savefig") else drawing.get_figure()
    if column:
        ensure_known("column", column, COLUMNS)
        figure.set_size_inches(COLUMNS[column], figure.get_figheight() * COLUMNS[column] / figure.get_figwidth())
    with mpl.rc_context({"pdf.fonttype": 42, "ps.fonttype": 42}):
        figure.savefig(target, dpi=300)
    return target
