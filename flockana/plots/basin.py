"""Certified radius of a basin beside the sampled share of returning starts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flockana.base.argument_kinds import check_kinds
from flockana.plots.palette import BLUE, INK, VERMILLION
from flockana.plots.style import LEGEND, ensure_axes, write_title
from flockana.plots.symbol_typesetting import typeset

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.certified.basin_sampling import SampledBasin


@check_kinds
def sampled_basin(sampled: SampledBasin, *, ax: Axes | None = None) -> Axes:
    """Draw the share of returning starts with 95 % intervals against the distance from the orbit, and certified ρ.

    What is certified of starts below the radius asks for an energy below the basin's level too.

    Parameters
    ----------
    sampled : SampledBasin
        Of `flockana.certified.basin_sampling.sample_basin`.
    """
    ax = ensure_axes(ax)
    d, basin = sampled.basin.law.alpha.d, sampled.basin
    low, high = sampled.interval()
    error_bars = [(sampled.shares - low).clip(0.0), (high - sampled.shares).clip(0.0)]
    label = f"{sampled.runs} starts each"
    ax.errorbar(sampled.distances / d, sampled.shares, yerr=error_bars, fmt="o", color=BLUE, label=label)
    ax.axvspan(0.0, basin.share, color=VERMILLION, alpha=0.15)
    ax.axvline(basin.share, color=VERMILLION, label=typeset(f"certified ρ = {basin.share:.3f} d"))
    ax.axhline(1.0, color=INK, linewidth=0.5)
    ax.set(ylim=(-0.05, 1.1), xlabel="distance from the orbit, over all coordinates, in d")
    ax.set(xlim=(0.0, None), ylabel="share of starts that return")
    write_title(ax, f"{type(basin.law).__name__}, n = {len(basin.rest)}: certified, and sampled")
    ax.legend(loc="lower left", **LEGEND)
    return ax
