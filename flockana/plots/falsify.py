"""Course of a search for a counterexample: the margin of each run, and the least margin so far."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.plots.palette import BLUE, INK, MUTED, VERMILLION
from flockana.plots.style import ensure_axes, finish, write_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike

    from flockana.falsify import Falsification

_WIDE = 1e3  # ratio of the sizes of margins from which on their axis is logarithmic on both sides of 0


@check_kinds
def falsification(found: Falsification, *, ax: Axes | None = None) -> Axes:
    """Draw a search: the claim's margin in each run, the least margin so far, and refuting runs.

    Parameters
    ----------
    found : flockana.falsify.Falsification
        What the search found.
    """
    return search_history(
        found.margins[found.claim],
        found.history,
        found=found.refuting(found.claim),
        label=f"{found.theorem}:{found.claim}",
        title=f"{found.theorem} on {found.scenario}",
        ax=ax,
    )


@check_kinds
def search_history(
    margins: ArrayLike, best: ArrayLike, *, found: Any = (), label: str = "", ax: Axes | None = None, title: str = ""
) -> Axes:
    """Draw a claim's margin in each run of a search, and the least so far; a negative margin refutes.

    Parameters
    ----------
    margins : array_like, shape (evaluations,)
        Of each run; runs on which nothing is claimed, NaN, are ticks at the foot.
    best : array_like, shape (evaluations,)
        Least margin up to each run.
    found : sequence of int
        Which runs refute the claim, counted from 0.
    label : str
        Name of the claim.
    """
    values, best_so_far = (np.asarray(series, dtype=np.float64) for series in (margins, best))
    if values.ndim != 1 or values.shape != best_so_far.shape or not values.size:
        raise ArgumentError(f"margins {values.shape}, best {best_so_far.shape}: expected one number per run in each")
    axes = ensure_axes(ax)
    run = np.arange(1, values.size + 1)
    solid = np.isfinite(values)
    axes.plot(run[solid], values[solid], "o", color=MUTED, markersize=2.5, label="one run")
    axes.step(run, best_so_far, where="post", color=BLUE, linestyle="-", label="smallest margin so far")
    axes.axhline(0.0, color=INK, linewidth=0.9, linestyle=":", label="refuted below 0")
    hit_numbers = np.asarray(found, dtype=np.int64)
    if hit_numbers.size:
        plot_style = {"markersize": 9, "markerfacecolor": "none", "markeredgewidth": 1.5, "linestyle": "none"}
        axes.plot(run[hit_numbers], values[hit_numbers], "s", color=VERMILLION, label="refuted", **plot_style)
    if not solid.all():
        foot = axes.get_xaxis_transform()
        axes.plot(run[~solid], np.full((~solid).sum(), 0.02), "|", color=MUTED, transform=foot, label="no margin")
    _scale(axes, values[solid])
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlim(0.5, values.size + 0.5)
    axes.yaxis.get_offset_text().set(x=-0.09, ha="center")  # a power of ten, which would lie under the legend
    if title:
        write_title(axes, title, pad=28)
    y = f"margin of {label}" if label else "margin"
    return finish(axes, "run of the search; the first is the scenario's own start", y)


def _scale(axes: Any, values: FloatArray) -> None:
    magnitudes = np.abs(values[values != 0.0])
    if magnitudes.size and magnitudes.max() > _WIDE * magnitudes.min():
        knee = max(float(np.quantile(magnitudes, 0.1)), 1e-6 * float(magnitudes.max()))
        axes.set_yscale("symlog", linthresh=knee)
