"""Axes to draw on, and what stands on them; matplotlib keeps places in space, and films, to itself."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure


def axes(m=2):
    """Axes of their own for a line, the plane or space."""
    return Figure().add_subplot(projection="3d" if m == 3 else None)


def points(collection):
    """Places of markers, in the plane or in space."""
    flat = getattr(collection, "_offsets3d", None)
    return np.asarray(collection.get_offsets()) if flat is None else np.column_stack(flat)


def segments(collection):
    """Lines in space, each with its points."""
    return collection._segments3d


def title(ax):
    return ax.get_title(loc="left") + ax.get_title()


def frame(film, k):
    """The axes of a film as they stand in frame k."""
    film._func(k)
    film._draw_was_started = True  # else matplotlib warns of a film that nobody saw
    film._fig.canvas.draw()
    (ax,) = film._fig.axes
    return ax
