"""Plots of a recording: measures with error bands, and accelerations unexplained by a law."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.value_checks import ensure_known
from flockana.base.vector_norms import lengths
from flockana.plots.palette import BLUE
from flockana.plots.style import ensure_axes, finish_over_time

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

    from flockana.recorded.compare import Comparison


def recorded_measure(seen: xarray.Dataset, name: str, *, ax: Axes | None = None) -> Axes:
    """Draw one measure of a recording over time, with its error as a band."""
    names = [str(key) for key in seen if f"{key}_error" in seen]
    values, ax = seen[ensure_known("measure", name, names)], ensure_axes(ax)
    t, error = seen["time"].values, seen[f"{name}_error"].values
    ax.plot(t, values, color=BLUE, linestyle="-")
    is_positive_measure = float(values.min()) >= 0.0
    if np.isfinite(error).any():
        low = np.maximum(values - error, 0.0) if is_positive_measure else values - error
        ax.fill_between(t, low, values + error, color=BLUE, alpha=0.25, linewidth=0.0)
    unit = values.attrs.get("units", "")
    label = str(values.attrs.get("long_name", name)) + (f" ({unit})" if unit not in ("", "1") else "")
    if is_positive_measure:
        ax.set_ylim(bottom=0.0)
    return finish_over_time(ax, t, label)


def residuals(comparison: Comparison, *, ax: Axes | None = None) -> Axes:
    """Draw the residual acceleration of each agent over time: darker is more."""
    ax = ensure_axes(ax)
    size = lengths(comparison.residual).T
    t = comparison.t
    step = float(np.median(np.diff(t))) if len(t) > 1 else 1.0
    edges: Any = np.concatenate([t - 0.5 * step, [t[-1] + 0.5 * step]])
    image = ax.pcolormesh(edges, np.arange(size.shape[0] + 1) - 0.5, size, cmap="cividis_r", rasterized=True)
    ax.figure.colorbar(image, ax=ax, label="‖residual‖ (length/time²)")
    ax.set(xlabel="time", ylabel="agent", title=f"left unexplained by {type(comparison.law).__name__}")
    return ax
