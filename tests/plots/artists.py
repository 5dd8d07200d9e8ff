"""Axes to draw on, and what stands on them; matplotlib keeps places in space, and films, to itself."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from flockana import Algorithm2, DiscreteLaw, LinearTarget, simulate


@dataclass(frozen=True)
class Halving(DiscreteLaw):
    """Each step halves every distance: no range, no energy, no target."""

    dt: float = 0.5

    def step(self, t, q, p, memory):
        return 0.5 * q, p, 0.0 * q, memory


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


def a_run(m=2, n=4):
    """Agents from anywhere, pulled after a γ-agent in uniform motion, at tenths of a time unit."""
    target = LinearTarget((1.0,) * m, (2.0,) * m)
    q = np.random.default_rng(0).uniform(0.0, 12.0, (n, m))
    law, times = Algorithm2(target=target), np.linspace(0.0, 1.0, 11)
    return simulate(law, q, 0.0 * q, (0.0, 1.0), t_eval=times, method="scipy-DOP853")  # which compiles no integrator
