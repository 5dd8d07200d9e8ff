"""A figure as an image that a page can hold: drawn once, in 256 colours."""

from __future__ import annotations

import base64
from collections.abc import Callable
from io import BytesIO
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from flockana import plots
from flockana.plots.scales import plain_scales
from flockana.report.layout import place_axes

_DPI = 125
_COMMON = 64  # colours that are kept as they are
_CELLS, _WHITE = 1 << 18, 0xFFFFFFFF
_LEVEL = 6  # of compression: 9 takes six times as long and saves a tenth


def png(draw: Callable[[Figure], None], size: tuple[float, float]) -> str:
    """A figure in flockana's look, as a ``data:`` address."""
    buffer = BytesIO()
    reduced(np.asarray(drawn(draw, size).buffer_rgba())).save(buffer, "png", compress_level=_LEVEL)
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")


def drawn(draw: Callable[[Figure], None], size: tuple[float, float], *, dpi: float = _DPI) -> Any:
    """The canvas of a figure in flockana's look, of a size in inches, drawn."""
    with plots.style(), mpl.rc_context({"axes.titley": 1.0}):  # else matplotlib asks all axes where it may stand
        figure = Figure(figsize=size, dpi=dpi)  # not pyplot's: nothing to close, safe in any process
        figure.set_layout_engine("none")
        canvas: Any = FigureCanvasAgg(figure)
        draw(figure)
        place_axes(figure, canvas.get_renderer(), plain_scales(figure))
        canvas.draw()
    return canvas


def reduced(pixels: npt.NDArray[np.uint8]) -> Image.Image:
    """An image with a palette, which makes drawings three times smaller, and no eye can tell.

    Colours that agree in their six leading bits are one. The commonest, of paper, panes and grids, are kept; of the
    others so many are chosen as cover all.

    Parameters
    ----------
    pixels : uint8 array, shape (height, width, 4)
        Red, green, blue, and an opacity that is not looked at.

    Examples
    --------
    >>> image = reduced(np.full((2, 3, 4), 255, dtype=np.uint8))
    >>> image.size, image.convert("RGB").getpixel((0, 0))
    ((3, 2), (255, 255, 255))
    """
    colours = np.ascontiguousarray(pixels).view("<u4")[:, :, 0]
    cells = (colours >> 2) & 0x3F | (colours >> 4) & 0xFC0 | (colours >> 6) & 0x3F000
    counts, seen = np.bincount(cells.ravel(), minlength=_CELLS), np.zeros(_CELLS, dtype="<u4")
    seen[cells] = colours  # one of each cell stands for it
    seen[-1] = _WHITE
    used = np.flatnonzero(counts)
    used = used[np.argsort(-counts[used], kind="stable")]
    common, rest = used[:_COMMON], used[_COMMON:]
    palette, index = _colours(seen[common]), np.zeros(_CELLS, dtype=np.uint8)
    index[common] = np.arange(common.size)
    if rest.size:
        covering = Image.fromarray(_colours(seen[rest])[None]).quantize(
            256 - _COMMON, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
        )
        index[rest] = common.size + np.asarray(covering).ravel()
        palette = np.concatenate([palette, np.array(covering.getpalette(), dtype=np.uint8).reshape(-1, 3)])
    image = Image.fromarray(index[cells], mode="P")
    image.putpalette(palette.tobytes())
    return image


def _colours(packed: npt.NDArray[np.uint32]) -> npt.NDArray[np.uint8]:
    """Red, green and blue of packed colours, shape (N, 3)."""
    return np.ascontiguousarray(packed).view(np.uint8).reshape(-1, 4)[:, :3]
