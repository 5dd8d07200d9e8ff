"""Write one drawing to a file that the user names."""

from __future__ import annotations

import os
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from flockana.base.errors import ArgumentError
from flockana.base.files import ensure_folder_of, ensure_target, write_atomic

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KINDS = (".png", ".svg", ".pdf")
_SIZE = (7.2, 5.4)
_DPI = 160


def ensure_file(path: Path | None, kinds: tuple[str, ...] = KINDS) -> None:
    """Raise if a path cannot take a picture: a folder, an unknown file type or an unwritable place."""
    if path is None:
        return
    if os.path.isdir(path):
        raise ArgumentError(f"{path} is a folder: expected a file name, such as {path / ('it' + kinds[0])}")
    if path.suffix.lower() not in kinds:
        raise ArgumentError(f"{path}: expected a file name that ends in {' or '.join(kinds)}")
    ensure_target(path)
    ensure_folder_of(path)


def write_picture(draw: Callable[[Axes], object], path: Path | None, *, m: int = 2) -> None:
    """Draw on new axes and save as PNG, SVG or PDF by file name; do nothing without a file."""
    write_figure(lambda figure: draw(figure.add_subplot(projection="3d" if m == 3 else None)), path)


def write_figure(draw: Callable[[Figure], object], path: Path | None, *, size: tuple[float, float] = _SIZE) -> None:
    """Draw on a new figure and save as PNG, SVG or PDF by file name; do nothing without a file."""
    if path is None:
        return
    from matplotlib.figure import Figure

    from flockana.plots.style import style

    drawing = BytesIO()  # in memory first: writers of PDF fall over a disk that fills
    with style():
        figure = Figure(figsize=size, layout="constrained")
        draw(figure)
        figure.savefig(drawing, dpi=_DPI, format=path.suffix[1:].lower())
    write_atomic(path, drawing.getvalue())
