"""One look for every figure, as a context: matplotlib's global settings are never touched."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
from cycler import cycler
from matplotlib.colors import LinearSegmentedColormap

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's colours: told apart with every common kind of colour vision, and here always paired with a dash
BLUE, ORANGE, GREEN, VERMILLION, PURPLE = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7"
INK, MUTED, FAINT = "#222222", "#6b6b6b", "#d9d9d9"

# lightness rises from compressed to stretched, so that it reads in grey; the middle is grey, not white, so that
# a link at its desired length shows on paper
STRAIN = LinearSegmentedColormap.from_list("strain", ["#00356b", "#2f6fb0", "#8a8a8a", "#d98a2b", "#f5b83d"])

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
}


@contextmanager
def style() -> Iterator[None]:
    """Draw in flockana's look inside a ``with`` block; outside of it nothing changes.

    Examples
    --------
    >>> import matplotlib
    >>> with style():
    ...     inside = matplotlib.rcParams["axes.spines.top"]
    >>> inside, matplotlib.rcParams["axes.spines.top"]
    (False, True)
    """
    with mpl.rc_context(_STYLE):  # type: ignore[arg-type]  # the stubs know each key's type, a plain dict does not
        yield


def ensure_axes(ax: Any, *, m: int = 2) -> Axes:
    """Return `ax`, or new axes in flockana's look: flat ones, or three-dimensional ones for m = 3.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        What the caller gave.
    m : int
        Dimension of what will be drawn.
    """
    if ax is not None:
        return ax  # type: ignore[no-any-return]
    import matplotlib.pyplot as plt

    with style():
        figure = plt.figure(figsize=(5.2, 4.2))
        return figure.add_subplot(projection="3d" if m == 3 else None)
