"""Paths and velocity diameters of one start under many laws, side by side."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.dynamics.trajectory import Trajectory
from flockana.measures.nets import links
from flockana.plots.palette import BLUE, FAINT, GREEN, INK, MUTED, PURPLE, VERMILLION
from flockana.plots.style import ensure_axes, finish_over_time, lines, subplots, write_title
from flockana.plots.symbol_typesetting import typeset
from flockana.scenarios.one_start import RANGE, Outcome

_COLUMNS = 5
_DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
_LOOKS = tuple(zip((BLUE, VERMILLION, GREEN, PURPLE, INK), _DASHES, strict=True))
_MARKS = (None, "o", "s", "^")  # a marker for each repetition of the colours and dashes
_FLOOR = 1e-8  # of the start: below it is what an integration leaves


@check_kinds
def side_by_side(outcomes: Sequence[Outcome], *, ax: Any = None) -> Any:
    """Draw the paths of one start under each law, on one scale: hollow starts, links at the end.

    Parameters
    ----------
    outcomes : sequence of Outcome
        What `flockana.scenarios.one_start.compare` gave.
    ax : sequence of Axes, optional
        One for each; by default a new figure, five in a row.

    Returns
    -------
    ndarray of matplotlib.axes.Axes
        One for each outcome.
    """
    if not outcomes:
        raise ArgumentError("outcomes is empty: expected those of flockana.scenarios.one_start.compare()")
    if ax is None:
        columns = min(_COLUMNS, len(outcomes))
        rows = -(-len(outcomes) // columns)
        ax = np.ravel(subplots(rows, columns, size=(3.1 * columns, 3.2 * rows))[1])
        for unused_axes in ax[len(outcomes) :]:
            unused_axes.remove()
        ax = ax[: len(outcomes)]
    panels = np.ravel(ax)
    if len(panels) != len(outcomes):
        raise ArgumentError(f"{len(panels)} axes for {len(outcomes)} laws: expected one for each")
    all_places = np.concatenate([outcome.run.q.reshape(-1, 2) for outcome in outcomes])
    low, high = all_places.min(axis=0), all_places.max(axis=0)
    midpoint, half_width = 0.5 * (low + high), 0.54 * float((high - low).max())
    for outcome, panel in zip(outcomes, panels, strict=True):
        _paths(panel, outcome.run)
        write_title(panel, f"{outcome.entry.name}\n{outcome.entry.theorem}: {outcome.verdict.status}", fontsize=9)
        panel.set(xlabel=typeset("x (length)"), ylabel=typeset("y (length)"), box_aspect=1.0)
        panel.set(xlim=midpoint[0] + (-half_width, half_width), ylim=midpoint[1] + (-half_width, half_width))
    return panels


def _paths(ax: Any, run: Trajectory) -> None:
    ax.add_collection(lines(run.q.transpose(1, 0, 2), colors=FAINT, linewidths=0.9, zorder=1))
    for q, colour in ((run.q[0], MUTED), (run.q[-1], BLUE)):
        ax.add_collection(lines(q[links(q, RANGE)], colors=colour, linewidths=0.8, zorder=2))
    ax.scatter(*run.q[0].T, s=12, facecolors="white", edgecolors=MUTED, linewidths=0.8, zorder=3)
    ax.scatter(*run.q[-1].T, s=12, color=INK, linewidths=0, zorder=3)


@check_kinds
def velocity_diameters(outcomes: Sequence[Outcome], *, ax: Axes | None = None) -> Axes:
    """Draw the greatest difference of two velocities over that at the start, over time, for each law.

    Parameters
    ----------
    outcomes : sequence of Outcome
        What `flockana.scenarios.one_start.compare` gave.
    """
    if not outcomes:
        raise ArgumentError("outcomes is empty: expected those of flockana.scenarios.one_start.compare()")
    axes: Any = ensure_axes(ax)
    for k, (outcome, (colour, dash)) in enumerate(zip(outcomes, cycle(_LOOKS), strict=False)):
        values = outcome.run.metric("velocity_diameter")
        share = np.maximum(values / values[0], _FLOOR)
        plot_style = {"marker": _MARKS[k // len(_LOOKS) % len(_MARKS)], "markevery": 0.1, "markersize": 3.5}
        axes.plot(outcome.run.t, share, color=colour, linestyle=dash, label=outcome.entry.name, **plot_style)
    axes.set_yscale("log")
    return finish_over_time(axes, outcomes[0].run.t, "velocity diameter over that at the start")
