"""Ensembles: shares with confidence intervals, distributions over runs, phase diagrams."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patches import Rectangle
from matplotlib.ticker import PercentFormatter

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_known
from flockana.plots.palette import BLUE, FAINT, GREEN, MUTED, ORANGE, VERMILLION
from flockana.plots.style import ABOVE, LEGEND, ensure_axes, write_title
from flockana.plots.symbol_typesetting import typeset

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

_MARKS = "osD^v<>"
_DODGE = 0.012  # of the axes' width, between curves that share their abscissae
_MOST = 7  # curves that can be distinguished
_LINE = 105  # characters that fit side by side above the axes
# colour, hatch: distinguished in grey by their lightness and, where that is close, by the hatch
_PHASES = {"flocking": (GREEN, ""), "fragmentation": (ORANGE, "//"), "collapse": (VERMILLION, "xx")}
_PHASES |= {"other": (FAINT, "..")}


@check_kinds
def share_against(
    table: xarray.Dataset,
    parameter: str,
    *,
    claims: Iterable[str] | None = None,
    of: str = "verified",
    ax: Axes | None = None,
    title: str = "",
) -> Axes:
    """Draw the share of runs in which claims are verified (or refuted) against a parameter, with interval bars.

    Parameters
    ----------
    table : xarray.Dataset
        From `flockana.ensemble.shares`, with the parameter as its only one.
    parameter : str
        Its name; an axis of numbers, or of names.
    claims : iterable of str, optional
        Which, at most seven; by default all.
    of : {"verified", "refuted"}
        Which share.
    """
    chosen_claims = _ensure_table(table, {parameter}, claims, of)
    curves = _alike(table, chosen_claims, of)
    if len(curves) > _MOST:
        text = f"{len(chosen_claims)} claims: expected at most {_MOST} in one picture"
        raise ArgumentError(f"{text}; choose some by claims=[...]")
    axes = ensure_axes(ax)
    values = table[parameter].values
    is_numeric = values.dtype.kind in "iuf"
    place: FloatArray = values.astype(np.float64) if is_numeric else np.arange(float(len(values)))
    logarithmic = is_numeric and _geometric(place)
    axis_values = np.log(place) if logarithmic else place
    spread = float(np.ptp(axis_values)) or 1.0
    for k, (claim, label) in enumerate(curves.items()):
        part = table.sel(claim=claim, of=of)
        shift = _DODGE * spread * (k - 0.5 * (len(curves) - 1))
        at = np.exp(axis_values + shift) if logarithmic else place + shift
        share = part.share.values
        bars = np.abs(np.stack([share - part.low.values, part.high.values - share]))
        axes.errorbar(at, share, yerr=bars, marker=_MARKS[k], markersize=4, capsize=2, elinewidth=0.9, label=label)
    if logarithmic:
        axes.set_xscale("log")
    if not is_numeric:
        axes.set_xticks(place, [str(value) for value in values.tolist()])
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    label = f"share of runs {of}, {100 * table.attrs['level']:g} % intervals"
    axes.set(xlabel=parameter, ylabel=label, ylim=(-0.03, 1.03))
    return _finish(axes, title)


def _alike(table: xarray.Dataset, claims: Sequence[str], of: str) -> dict[str, str]:
    """Return the first claim of each group with identical curves, with the names of all in the group."""
    groups: dict[bytes, list[str]] = {}
    for claim in claims:
        part = table.sel(claim=claim, of=of)
        groups.setdefault(b"".join(part[name].values.tobytes() for name in ("share", "low", "high")), []).append(claim)
    return {names[0]: ", ".join(names) for names in groups.values()}


def _geometric(places: FloatArray) -> bool:
    """Return whether positive numbers are spaced geometrically, over a decade or more."""
    if len(places) < 2 or not (places > 0.0).all() or places.max() < 10.0 * places.min():
        return False
    if len(places) == 2:
        return True
    step_widths, ratios = np.diff(np.sort(places)), np.diff(np.log(np.sort(places)))
    return bool(step_widths.max() * ratios.min() > ratios.max() * step_widths.min())


@check_kinds
def share_bars(
    table: xarray.Dataset, *, claims: Iterable[str] | None = None, ax: Axes | None = None, title: str = ""
) -> Axes:
    """Draw for each claim the shares of runs in which it is verified and refuted, with their intervals.

    Parameters
    ----------
    table : xarray.Dataset
        From `flockana.ensemble.shares`, without parameters.
    claims : iterable of str, optional
        Which; by default all.
    """
    chosen_claims = _ensure_table(table, set(), claims, "verified")
    axes, part = ensure_axes(ax), table.sel(claim=chosen_claims)
    names = "share", "low", "high"
    shares = {of: np.array([part[name].sel(of=of).values for name in names]) for of in ("verified", "refuted")}
    return draw_bars(axes, chosen_claims, shares, part.runs.values, table.attrs["level"], title)


def draw_bars(
    axes: Any, claims: Sequence[str], shares: Mapping[str, FloatArray], runs: Any, level: float, title: str = ""
) -> Axes:
    """Draw rows of `share_bars`: shares and the ends of their intervals, shape (3, M), by status."""
    rows = np.arange(len(claims))[::-1]
    for status_name, colour, mark, shift in (("verified", BLUE, "o", 0.12), ("refuted", VERMILLION, "s", -0.12)):
        share, low, high = shares[status_name]
        is_finite = np.isfinite(share)
        axes.hlines(rows[is_finite] + shift, low[is_finite], high[is_finite], color=colour, linewidth=1.4)
        fill_colour = colour if status_name == "verified" else "white"
        style = {"color": colour, "markerfacecolor": fill_colour, "markersize": 5, "linestyle": "none"}
        axes.plot(share[is_finite], rows[is_finite] + shift, mark, label=status_name, **style)
    axes.set_yticks(rows, claims)
    axes.xaxis.set_major_formatter(PercentFormatter(1.0))
    run_counts_text = " to ".join(map(str, dict.fromkeys((int(np.min(runs)), int(np.max(runs))))))
    axes.set(ylim=(-0.6, len(claims) - 0.4), xlim=(-0.03, 1.03))
    axes.set_xlabel(f"share of {run_counts_text} runs, {100 * level:g} % intervals")
    return _finish(axes, title)


@check_kinds
def distribution(
    groups: Mapping[str, Any],
    *,
    quantity: str,
    bound: float | None = None,
    log: bool = False,
    ax: Axes | None = None,
    title: str = "",
) -> Axes:
    """Draw the cumulative distribution of a measure over runs.

    A cumulative curve, unlike a histogram, hides nothing in bins and lets groups be compared. Each run is a tick below.

    Parameters
    ----------
    groups : mapping of str to array_like
        One value per run, by the name of its group; NaN is left out.
    quantity : str
        What is measured, with its unit, such as ``"terminal δ/d"``.
    bound : float, optional
        A threshold to mark.
    log : bool
        A logarithmic axis; values that are not positive are left out and counted in the legend.
    """
    axes = ensure_axes(ax)
    count = 0
    for k, (name, values) in enumerate(groups.items()):
        x = np.sort(np.asarray(values, dtype=np.float64).ravel())
        x = x[np.isfinite(x)]
        data = x[x > 0.0] if log else x
        if not data.size:
            continue
        zero_count = x.size - data.size  # they count in the shares, although a logarithmic axis has no place for them
        note = f", {zero_count} at 0" if zero_count else ""
        share = (zero_count + np.arange(data.size + 1)) / x.size
        label = f"{name} ({x.size} runs{note})"
        (line,) = axes.step(np.concatenate([data[:1], data]), share, where="post", label=label)
        height = -0.02 - 0.03 * k
        axes.plot(data, np.full(data.size, height), "|", color=line.get_color(), markersize=5, markeredgewidth=0.7)
        count += 1
    if not count:
        raise ArgumentError(f"{quantity}: no finite value{' above 0' if log else ''} to draw; was the measure taken?")
    if bound is not None:
        axes.axvline(bound, color=MUTED, linestyle=":", linewidth=1.2, label=f"{bound:g}")
    if log:
        axes.set_xscale("log")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    axes.set(xlabel=quantity, ylabel="share of runs at or below", ylim=(-0.04 - 0.03 * len(groups), 1.03))
    return _finish(axes, title)


@check_kinds
def phase_diagram(
    phase: xarray.DataArray,
    x: str,
    y: str,
    *,
    ax: Axes | None = None,
    title: str = "",
    labels: Sequence[str] = ("", ""),
) -> Axes:
    """Draw over two parameters the phases in which runs ended; a cell shows the share of seeds in each phase.

    Parameters
    ----------
    phase : xarray.DataArray
        From `flockana.ensemble.phases`, with dimensions x, y and seed.
    x, y : str
        Names of the parameters; every value has a cell of one size.
    labels : (str, str)
        Of the axes, instead of the parameters' names.
    """
    if {*phase.dims} != {x, y, "seed"}:
        raise ArgumentError(f"phase has dimensions {', '.join(map(str, phase.dims))}: expected {x}, {y} and seed")
    axes = ensure_axes(ax)
    names = phase.attrs["flag_meanings"].split()
    codes = phase.transpose(x, y, "seed").values
    labels_seen: set[str] = set()
    for column, row in np.ndindex(*codes.shape[:2]):
        known_codes = codes[column, row][codes[column, row] >= 0]
        left = column - 0.5
        for code, count in zip(*np.unique(known_codes, return_counts=True), strict=True):
            width, name = float(count) / known_codes.size, names[code]
            colour, hatch = _PHASES[name]
            label = None if name in labels_seen else name
            plot_style: dict[str, Any] = {"facecolor": colour, "hatch": hatch, "edgecolor": "white", "linewidth": 0.0}
            axes.add_patch(Rectangle((left, row - 0.5), width, 1.0, label=label, **plot_style))
            left, labels_seen = left + width, labels_seen | {name}
    for axis, name, label in ((axes.xaxis, x, labels[0]), (axes.yaxis, y, labels[1])):
        values = phase[name].values.tolist()
        axis.set_ticks(range(len(values)), [f"{v:g}" if isinstance(v, int | float) else str(v) for v in values])
        axis.set_ticks(np.arange(-0.5, len(values)), minor=True)
        axis.set_label_text(typeset(label or name))
    axes.grid(visible=False)
    axes.grid(which="minor", color="white", linewidth=2.0)
    axes.set_axisbelow(False)
    axes.tick_params(which="both", length=0)
    axes.set(xlim=(-0.5, codes.shape[0] - 0.5), ylim=(-0.5, codes.shape[1] - 0.5))
    handles = {text: handle for handle, text in zip(*axes.get_legend_handles_labels(), strict=True)}
    order = [name for name in names if name in handles]
    plot_style = LEGEND | {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": len(order)}
    axes.legend([handles[name] for name in order], order, **plot_style)
    if title:
        write_title(axes, title, pad=26)
    return axes


def _ensure_table(table: xarray.Dataset, parameters: set[str], claims: Iterable[str] | None, of: str) -> list[str]:
    """Return the claims to draw; raise unless a table of shares has these parameters and no others."""
    if of not in ("verified", "refuted"):
        raise ArgumentError(f"of = {of!r}: expected 'verified' or 'refuted'")
    other_dimensions = {str(name) for name in table.runs.dims} - {"claim"}
    if other_dimensions != parameters:
        raise ArgumentError(
            f"the table is over {', '.join(sorted(other_dimensions)) or 'no parameter'}: expected "
            f"{', '.join(sorted(parameters)) or 'none'}; select values of the others by .sel(...)"
        )
    all_claims = [str(name) for name in table.claim.values]
    chosen_claims = all_claims if claims is None else list(claims)
    for name in chosen_claims:
        ensure_known("claim", name, all_claims)
    if not chosen_claims:
        raise ArgumentError("no claims: expected at least one; were theorems checked?")
    return chosen_claims


def _finish(axes: Any, title: str) -> Axes:
    """Put the legend above the axes, in as many columns as fit, and the title above it."""
    labels = axes.get_legend_handles_labels()[1]
    columns = max(1, min(4, len(labels), _LINE // (6 + max(len(text) for text in labels))))
    axes.legend(ncols=columns, **LEGEND, **ABOVE)
    if title:
        write_title(axes, title, pad=10 + 14 * -(-len(labels) // columns))
    return axes
