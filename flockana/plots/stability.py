"""Linearised stability: poles, mode shapes on the flock, films of modes."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_links, ensure_points
from flockana.plots.animation import animate
from flockana.plots.palette import BLUE, FAINT, GREEN, INK, MUTED, PURPLE, VERMILLION
from flockana.plots.style import ensure_axes, finish, frame_space, in_plane, lines, star, write_title
from flockana.plots.symbol_typesetting import typeset
from flockana.stability.modes import Mode
from flockana.stability.motion_of_mode import mode_motion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.stability.linearisation import Linearisation

_LOOKS = (("x", BLUE), ("+", GREEN), ("1", PURPLE), ("2", INK))
_RATIOS = (0.1, 0.3, 0.5, 0.7, 0.9)
_ARROW = 0.09  # longest arrow as a share of the flock's width
_RING = np.linspace(0.0, 2.0 * np.pi, 49)


def pole_map(poles: Any, *, ax: Axes | None = None) -> Axes:
    """Draw eigenvalues in the complex plane: zero eigenvalues as a numbered ring, unstable ones as red triangles.

    Parameters
    ----------
    poles : array_like of complex, or mapping of str to array_like
        Eigenvalues; with labels, up to four groups.
    """
    groups = dict(poles) if isinstance(poles, Mapping) else {"eigenvalues": poles}
    try:
        values = {name: np.asarray(group, dtype=np.complex128).ravel() for name, group in groups.items()}
    except (TypeError, ValueError, OverflowError):
        text = f"poles = {format_value(poles)}: expected complex numbers, or groups of them by label"
        raise ArgumentError(text) from None
    whole = np.concatenate([*values.values(), np.empty(0)])
    if whole.size == 0 or np.isnan(whole).any():
        raise ArgumentError(f"poles = {format_value(poles)}: expected at least one eigenvalue, and no NaN")
    axes = ensure_axes(ax)
    axes.axhline(0.0, color=MUTED, linewidth=0.8, zorder=1)
    axes.axvline(0.0, color=INK, linewidth=1.0, zorder=1)
    for (marker, colour), (name, group) in zip(_LOOKS, values.items(), strict=False):
        decaying_poles = group[(group != 0.0) & (group.real <= 0.0)]
        plot_style: dict[str, Any] = {"color": colour, "markersize": 6.0, "markeredgewidth": 1.3, "zorder": 3}
        axes.plot(decaying_poles.real, decaying_poles.imag, marker, label=name, **plot_style)
    grows, zeros = whole[whole.real > 0.0], int(np.sum(whole == 0.0))
    if grows.size:
        axes.plot(grows.real, grows.imag, "^", color=VERMILLION, markersize=6.0, label="growing", zorder=3)
    if zeros:
        plot_style = {"color": INK, "markerfacecolor": "none", "markersize": 9.0, "zorder": 4}
        axes.plot(0.0, 0.0, "o", label=f"zero eigenvalues: {zeros}", **plot_style)
    axes.margins(0.08)
    axes.autoscale_view()
    height = max(1.2 * float(np.abs(whole.imag).max()), 0.2 * float(np.abs(whole).max()))  # real poles have none
    if height:
        axes.set_ylim(-height, height)
    _damping_rays(axes)
    return finish(axes, "Re s (1/time)", "Im s (rad/time)")


def _damping_rays(ax: Any) -> None:
    """Draw rays of constant damping ratio in the left half-plane, labelled at the edge of the axes."""
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    if left >= 0.0:
        return
    ax.grid(False)
    for ratio in _RATIOS:
        slope = np.sqrt(1.0 - ratio**2) / ratio
        for sign, edge in ((1.0, high), (-1.0, low)):
            if sign * edge <= 0.0:
                continue
            reach = min(-left, abs(edge) / slope)
            ax.plot([0.0, -reach], [0.0, sign * slope * reach], color=FAINT, linestyle="-", linewidth=0.7, zorder=0)
            if sign > 0.0:
                text, inner_reach = typeset(f"ζ = {ratio:g}"), 0.97 * reach
                ax.text(-inner_reach, slope * inner_reach, text, color=MUTED, fontsize=7, ha="left", va="top")
    ax.set(xlim=(left, right), ylim=(low, high))


def mode_shape(q: Any, links: Any, shape: Any, *, target: Any = None, ax: Axes | None = None, title: str = "") -> Axes:
    """Draw a mode on the flock: an arrow from each agent, and the ellipse of its oscillation.

    Parameters
    ----------
    q : array_like, shape (n, m)
        Positions, m = 1, 2 or 3.
    links : array_like, shape (M, 2)
    shape : array_like, shape (n, m)
        Displacements, real or complex, of any size: the longest arrow is a tenth of the flock.
    target : array_like, shape (m,), optional
        Position of the γ-agent.
    """
    points, moves = ensure_points("q", q), np.asarray(shape)
    if moves.shape != points.shape or moves.dtype.kind not in "iufc":
        raise ArgumentError(
            f"shape is {moves.shape} of {moves.dtype}: expected real numbers of shape {points.shape}, the shape of q"
        )
    links = ensure_links(links, len(points))
    m = points.shape[1]
    axes = ensure_axes(ax, m=m)
    points, moves = in_plane(points), in_plane(moves)
    extent = float(np.ptp(points, axis=0).max()) or 1.0
    moves = moves * (_ARROW * extent / (float(np.abs(moves).max()) or 1.0))
    if len(links):
        axes.add_collection(lines(points[links], colors=FAINT, linewidths=1.0, zorder=1))
    if np.iscomplexobj(moves):
        orbits = points[:, None] + np.real(np.exp(1j * _RING)[None, :, None] * moves[:, None])
        axes.add_collection(lines(orbits, colors=VERMILLION, linewidths=0.9, zorder=2))
    marker_size = float(np.clip(700.0 / len(points), 3.0, 22.0))
    axes.scatter(*points.T, s=marker_size, color=INK, linewidths=0, zorder=3)
    arrows = np.real(moves)
    if m == 3:
        axes.quiver(*points.T, *arrows.T, color=BLUE, linewidth=1.0, arrow_length_ratio=0.3)
    else:
        plot_style = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "width": 0.004, "color": BLUE, "zorder": 4}
        axes.quiver(*points.T, *arrows.T, **plot_style)
    corners = np.vstack([points, points + np.abs(moves), points - np.abs(moves)])
    if target is not None:
        position = in_plane(np.asarray(target, dtype=np.float64)[None, :])
        star(axes, position, s=90, color=PURPLE, zorder=3.5)
        corners = np.vstack([corners, position])
    write_title(axes, title)
    if m == 2:  # neither arrows nor collections count in the view
        axes.update_datalim(corners)
        axes.autoscale_view()
    return frame_space(axes, corners, m)


@check_kinds
def mode_title(mode: Mode) -> str:
    """Return the title of a mode's picture: its name, rate and frequency.

    Examples
    --------
    >>> mode_title(Mode(-3 + 4j, np.ones((1, 1)), "breathing"))
    'breathing: s = −3 ± 4i, ζ = 0.6'
    >>> mode_title(Mode(-3 + 0j, np.ones((1, 1)), "7")), mode_title(Mode(0j, np.ones((1, 1)), "rotation"))
    ('mode 7: s = −3', 'rotation: s = 0')
    """
    name = f"mode {mode.name}" if mode.name.isdigit() else mode.name
    real = f"{mode.eigenvalue.real:.3g}".replace("-", "−")
    if mode.frequency:
        return f"{name}: s = {real} ± {mode.frequency:.3g}i, ζ = {mode.damping_ratio:.2g}"
    return f"{name}: s = {real}"


def animate_mode(
    linearisation: Linearisation,
    mode: Mode,
    path: str | os.PathLike[str],
    *,
    seconds: float = 4.0,
    fps: float = 15.0,
    velocities: bool = False,
    progress: bool | Callable[[int, int], None] = True,
) -> Path:
    """Write a film of a mode: GIF always, MP4 where the program ffmpeg is installed.

    For another amplitude or number of periods, animate what `flockana.stability.mode_motion` gives.

    Parameters
    ----------
    linearisation : Linearisation
        Where the mode is from.
    path : path-like
        File to write, ``.gif`` or ``.mp4``.
    seconds, fps, velocities, progress : object
        As for `flockana.plots.animate`.
    """
    run = mode_motion(linearisation, mode)
    return animate(run, path, seconds=seconds, fps=fps, velocities=velocities, progress=progress)
