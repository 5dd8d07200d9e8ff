"""Lattices by coordination number, the collapse of Algorithm 2, and the collision barrier."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.ticker import FixedLocator, NullFormatter, ScalarFormatter

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_links, ensure_points, ensure_series
from flockana.plots.palette import BLUE, GREEN, INK, MUTED, ORANGE, PURPLE, STRAIN, VERMILLION
from flockana.plots.style import LEGEND, colour_bar, ensure_axes, finish, frame_space, in_plane, lines, write_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.equilibria.lattice_collapse import CollapseDiagram

_MOST = 12
_SKY, _YELLOW = "#56B4E9", "#F0E442"  # the rest of Okabe and Ito's colours
# marker and colour of an agent with k neighbours: from 3 to 6 a polygon with k corners; distinguishable in grey
_LOOKS: tuple[tuple[Any, str], ...] = (
    ("X", INK),
    ("o", MUTED),
    ("d", PURPLE),
    ("^", ORANGE),
    ("s", GREEN),
    ("p", VERMILLION),
    ("h", BLUE),
    ((7, 1, 0), _YELLOW),
    ("D", _SKY),
    ("v", PURPLE),
    ("P", ORANGE),
    ("<", VERMILLION),
    ("o", BLUE),
    ("*", INK),
)
_RASTER = 5000  # agents from which on a vector picture holds an image instead


def defect_map(
    q: Any,
    links: Any,
    coordination: Any,
    *,
    strain: Any = None,
    limit: float | None = None,
    ax: Axes | None = None,
    title: str = "",
) -> Axes:
    """Draw agents by their number of neighbours, in colour and shape, and links by their strain.

    Parameters
    ----------
    q : array_like, shape (n, m)
        Positions, m = 1, 2 or 3.
    links : array_like, shape (M, 2)
    coordination : array_like, shape (n,)
        Number of neighbours of each agent.
    strain : array_like, shape (M,), optional
        (length − d)/d of each link; without it links are grey.
    limit : float, optional
        Strain at the ends of the colour scale; by default the largest.
    """
    points = ensure_points("q", q)
    links, degrees = ensure_links(links, len(points)), ensure_series("coordination", coordination, len(points))
    if not ((degrees >= 0.0) & (degrees % 1.0 == 0.0)).all():
        raise ArgumentError("coordination has entries that are no counts: expected whole numbers >= 0")
    if strain is not None:
        strain = ensure_series("strain", strain, len(links))
    m = points.shape[1]
    x = in_plane(points)
    axes = ensure_axes(ax, m=m)
    if m == 3:
        axes.computed_zorder = False  # else links are drawn across the agents in front of them
    raster = len(x) > _RASTER
    if len(links):
        _draw_links(axes, x[links], strain, limit, raster)
    size = float(np.clip(2600.0 / len(x), 3.0, 70.0))
    shown_degrees = np.minimum(degrees, _MOST + 1).astype(np.intp)
    for k in np.unique(shown_degrees).tolist():
        (marker, colour), these = _LOOKS[k], x[shown_degrees == k]
        label = f"{k if k <= _MOST else f'{k} or more'} neighbour{'' if k == 1 else 's'}: {len(these)}"
        edge: dict[str, Any] = {"edgecolors": INK, "linewidths": 0.5 if size > 10.0 else 0.0}
        edge |= {"depthshade": False} if m == 3 else {}
        axes.scatter(*these.T, s=size, marker=marker, color=colour, label=label, zorder=3, rasterized=raster, **edge)
    write_title(axes, title)
    look = LEGEND | {"borderaxespad": 0.0, "handletextpad": 0.2, "columnspacing": 1.0}
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.14), ncols=2, **look)  # wider, it would squeeze the axes
    return frame_space(axes, x, m)


def _draw_links(ax: Any, segments: Any, strain: Any, limit: float | None, raster: bool) -> None:
    width = float(np.clip(20.0 / len(segments) ** 0.5, 0.3, 2.2)) * (0.6 if segments.shape[2] == 3 else 1.0)
    plot_style: dict[str, Any] = {"linewidths": width, "zorder": 2, "rasterized": raster}
    if strain is None:
        ax.add_collection(lines(segments, colors=MUTED, **plot_style))
        return
    end = (float(np.abs(strain).max()) if limit is None else limit) or 1.0
    coloured = lines(segments, array=strain, cmap=STRAIN, norm=Normalize(-end, end), **plot_style)
    ax.add_collection(coloured)
    extend_kind = ("min" if strain.min() < -end else "") + ("max" if strain.max() > end else "")
    extension = {"": "neither", "minmax": "both"}.get(extend_kind, extend_kind)
    colour_bar(ax, coloured, "strain of links (length − d)/d", extend=extension)


@check_kinds
def collapse(diagram: CollapseDiagram, *, ax: Axes | None = None) -> Axes:
    """Draw the shortest distance of relaxed flocks over size and c1γ/c1α, with coincident agents marked.

    Parameters
    ----------
    diagram : CollapseDiagram
        Shortest distances, sizes and ratios.
    """
    axes = ensure_axes(ax)
    places = np.stack(np.broadcast_arrays(diagram.sizes[:, None], diagram.ratios[None, :]))
    is_separated, is_coincident, is_failed = diagram.coincident == 0, diagram.coincident > 0, diagram.coincident < 0
    plot_style: dict[str, Any] = {"cmap": "cividis", "vmin": 0.0, "vmax": 1.0, "s": 34, "zorder": 3}
    dot_artist = axes.scatter(*places[:, is_separated], c=diagram.closest[is_separated], **plot_style)
    axes.scatter(*places[:, is_coincident], marker="x", color=VERMILLION, s=30, zorder=3, label="agents coincide")
    if is_failed.any():
        axes.scatter(*places[:, is_failed], marker="_", color=MUTED, s=30, label="no equilibrium found")
    axes.plot(diagram.sizes, diagram.onset(), color=INK, linestyle="--", linewidth=1.0, label="onset")
    colour_bar(axes, dot_artist, "least distance over d", share=1.0)
    return _over_size(axes, diagram.sizes.tolist(), "c1γ/c1α")


@check_kinds
def collapse_brackets(brackets: Mapping[int, Sequence[float]], *, ax: Axes | None = None) -> Axes:
    """Draw brackets of the ratio c1γ/c1α at which a flock collapses, against its size.

    Parameters
    ----------
    brackets : mapping of int to (float, float)
        By number of agents: the largest ratio seen safe, the least seen to collapse.
    """
    axes = ensure_axes(ax)
    counts = sorted(brackets)
    low, high = np.array([brackets[n] for n in counts]).T
    axes.vlines(counts, low, high, color=MUTED, linewidth=1.2, zorder=2)
    axes.plot(counts, high, marker="x", color=VERMILLION, linestyle="--", linewidth=1.0, label="agents coincide")
    axes.plot(counts, low, marker="o", color=BLUE, linestyle="-", linewidth=1.0, label="all stay apart")
    return _over_size(axes, counts, "c1γ/c1α")


@check_kinds
def barrier(
    together: Mapping[int, float], lowest: Mapping[int, float], c_star: float, *, ax: Axes | None = None
) -> Axes:
    """Draw the least energies with and without two coincident agents, and their difference, against n in units of c*.

    Where the least energy of all is above 1, no state meets the printed condition V < c*.

    Parameters
    ----------
    together, lowest : mapping of int to float
        Least energies, by number of agents.
    c_star : float
        The printed bound, ψ_α(0).
    """
    axes = ensure_axes(ax)
    sizes = sorted(together)
    upper, lower = (np.array([energy[n] for n in sizes]) / c_star for energy in (together, lowest))
    axes.plot(sizes, upper, marker="x", color=VERMILLION, linestyle="--", label="least V with two agents coincident")
    axes.plot(sizes, lower, marker="o", color=BLUE, linestyle="-", label="least V of all states")
    axes.plot(sizes, upper - lower, marker="s", color=GREEN, linestyle="-.", label="barrier")
    axes.axhline(1.0, color=INK, linewidth=0.9, linestyle=":", label="c*")
    axes.set_ylim(bottom=0.0)
    return _over_size(axes, sizes, "energy over c*", logarithmic=False)


def _over_size(ax: Any, sizes: Sequence[int], label: str, *, logarithmic: bool = True) -> Axes:
    """Label axes over the number of agents; label every size if there are few."""
    if logarithmic:
        ax.set_yscale("log")
        minor_formatter = ScalarFormatter() if np.ptp(np.log10(ax.get_ylim())) < 1.5 else NullFormatter()
        ax.yaxis.set(major_formatter=ScalarFormatter(), minor_formatter=minor_formatter)
    if len(sizes) <= 12:
        ax.xaxis.set_major_locator(FixedLocator(sizes))
    return finish(ax, "n, agents", label)
