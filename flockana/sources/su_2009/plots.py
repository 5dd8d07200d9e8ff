"""Share of followers against the share of informed agents."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.ticker import PercentFormatter

from flockana.base.argument_kinds import check_kinds
from flockana.base.binomial_intervals import clopper_pearson
from flockana.base.errors import ArgumentError
from flockana.plots.palette import BLUE, MUTED, ORANGE
from flockana.plots.style import ensure_axes, finish, place_legend, write_title

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

_CONFIDENCE = 0.95


@check_kinds
def informed_shares(
    runs: xarray.Dataset, *, agents: int = 60, majority: float = 0.5, ax: Axes | None = None, title: str = ""
) -> Axes:
    """Draw the share of followers in each run, its mean, and how often a majority follows, with intervals.

    Agents of one run are not independent of each other, so an exact interval (Clopper and Pearson, 95 %) is of the
    share of runs in which more than a majority follows; the mean over runs has none.

    Parameters
    ----------
    runs : xarray.Dataset
        From `flockana.ensemble("informed-survey", seeds, parameters={"informed": ...}, metrics=["followers"])`.
    agents : int
        How many agents there are.
    majority : float
        The share of agents that a run must exceed to count, 0 <= majority < 1.
    """
    if "followers" not in runs or "informed" not in runs.get("followers", runs).dims:
        raise ArgumentError(
            f"the dataset has {', '.join(map(str, runs.data_vars)) or 'nothing'}: expected 'followers' over "
            "'informed', as of ensemble('informed-survey', ..., parameters={'informed': ...}, metrics=['followers'])"
        )
    if not 0.0 <= majority < 1.0:
        raise ArgumentError(f"majority = {majority!r}: expected a share, 0 <= majority < 1")
    share = runs["followers"].transpose("informed", "seed").values
    x = np.asarray(runs["informed"].values, dtype=np.float64) / agents
    is_finite = np.isfinite(share)  # a run that failed has none
    counts, run_counts = (share > majority).sum(axis=1), is_finite.sum(axis=1)
    low, high = (np.atleast_1d(end) for end in clopper_pearson(counts, run_counts, level=_CONFIDENCE))
    success_shares = counts / np.maximum(run_counts, 1)
    axes = ensure_axes(ax)
    for position, row in zip(x, share, strict=True):
        axes.plot(np.full(row.shape, position), row, ".", color=MUTED, alpha=0.5, zorder=1)
    axes.plot(x, np.nanmean(share, axis=1), "-o", color=BLUE, label="agents that follow, mean of all runs")
    bars = np.clip([success_shares - low, high - success_shares], 0.0, None)
    label = f"runs in which more than {majority:.0%} follow, with 95 % intervals"
    axes.errorbar(x, success_shares, bars, fmt="s", color=ORANGE, capsize=3.0, label=label)
    axes.set_ylim(-0.03, 1.03)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(PercentFormatter(1.0))
    write_title(axes, title)
    place_legend(axes)
    return finish(axes, "share of agents that are informed", "share")
