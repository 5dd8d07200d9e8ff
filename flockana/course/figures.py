"""Explanatory figures of the lectures, each drawn on given or new axes.

Lines differ by colour and dash, areas by lightness, so that every figure reads with any colour vision and in grey.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from flockana.interactions import AlphaInteraction
from flockana.plots.palette import BLUE, FAINT, GREEN, INK, MUTED, VERMILLION
from flockana.plots.style import ensure_axes, finish, write_title

_CIRCLE = np.linspace(0.0, 2.0 * np.pi, 200)


def net(n: int, links: Sequence[tuple[int, int]], *, title: str = "", ax: Any = None) -> Any:
    """Draw a net of n numbered agents on a circle."""
    ax = _plain(ensure_axes(ax))
    angle = np.pi / 2.0 - 2.0 * np.pi * np.arange(n) / n
    q = np.column_stack([np.cos(angle), np.sin(angle)])
    for i, j in links:
        ax.plot(*q[[i, j]].T, color=MUTED, linestyle="-", linewidth=1.2, zorder=1)
    ax.scatter(*q.T, s=170, color="white", edgecolors=INK, zorder=2)
    for k, position in enumerate(q):
        ax.text(*position, f"{k + 1}", ha="center", va="center", fontsize=8, zorder=3)
    ax.set(xlim=(-1.35, 1.35), ylim=(-1.35, 1.35))
    write_title(ax, title)
    return ax


def pair_vector(eps: float = 0.1, *, axes: Any) -> Any:
    """Draw n_ij beside q_j - q_i in the plane, and both lengths over the distance, on two axes."""
    plane, length_axes = _plain(axes[0]), axes[1]
    i, j = np.array([0.0, 0.0]), np.array([6.0, 2.0])
    n = (j - i) / np.sqrt(1.0 + eps * (j - i) @ (j - i))
    _arrow(plane, i, j, BLUE, "--")
    _arrow(plane, i, i + n, VERMILLION, "-", width=2.2)
    for position, name, offset in ((i, "$q_i$", (-4, -14)), (j, "$q_j$", (4, 4))):
        plane.plot(*position, "o", color=INK, markersize=6)
        _note(plane, name, position, offset)
    _note(plane, "$q_j-q_i$", 0.72 * j, (-2, 8), color=BLUE, ha="right")
    _note(plane, "$n_{ij}$", i + 0.6 * n, (6, -14), color=VERMILLION)
    plane.set(xlim=(-1.2, 7.5), ylim=(-1.6, 3.4))
    x = np.linspace(0.0, 12.0, 300)
    length_axes.plot(x, x, color=BLUE, linestyle="--", label="$\\|q_j-q_i\\|$")
    length_axes.plot(x, x / np.sqrt(1.0 + eps * x**2), color=VERMILLION, linestyle="-", label="$\\|n_{ij}\\|$")
    length_axes.axhline(eps**-0.5, color=MUTED, linestyle=":", label="$1/\\sqrt{\\varepsilon}$")
    length_axes.set_ylim(0.0, 6.0)
    finish(length_axes, "distance of the pair (length)", "length of the vector")
    return axes


def norms(eps: Sequence[float] = (0.1, 1.0), *, ax: Any = None) -> Any:
    """Draw the Euclidean norm, with its corner, and σ-norms, without one, of a number x."""
    ax = ensure_axes(ax)
    x = np.linspace(-4.0, 4.0, 401)
    ax.plot(x, np.abs(x), color=BLUE, linestyle="--", label="Euclidean norm")
    for item, colour, dash in zip(eps, (VERMILLION, GREEN), ("-", "-."), strict=False):
        norm = AlphaInteraction(eps=item).sigma_norm(np.abs(x))
        ax.plot(x, norm, color=colour, linestyle=dash, label=f"σ-norm, ε = {item:g}")
    ax.annotate("corner", (0.0, 0.0), (0.9, 0.1), fontsize=8, arrowprops={"arrowstyle": "->", "color": MUTED})
    return finish(ax, "x (length)", "norm of x")


def bumps(h: Sequence[float] = (0.2, 0.6, 0.9), *, ax: Any = None) -> Any:
    """Draw bump functions: 1 up to h, 0 from 1 on, half a cosine between."""
    ax = ensure_axes(ax)
    z = np.linspace(0.0, 1.2, 400)
    for item, colour, dash in zip(h, (BLUE, VERMILLION, GREEN), ("-", "--", "-."), strict=False):
        ax.plot(z, AlphaInteraction(h=item).bump(z), color=colour, linestyle=dash, label=f"h = {item:g}")
        ax.plot([item], [1.0], "o", color=colour, markersize=4)
    return finish(ax, "z (no unit)", "$\\rho_h(z)$")


def wall_and_well(interaction: Any, *, ax: Any = None) -> Any:
    """Draw a pair's potential over the distance, with the well about d enlarged in an inset."""
    ax = ensure_axes(ax)
    x = np.linspace(0.0, 1.15 * interaction.r, 500)
    psi = interaction.psi_alpha(interaction.sigma_norm(x))
    rim = float(interaction.psi_alpha(interaction.r_alpha))
    ax.plot(x, psi, color=BLUE, linestyle="-")
    ax.plot([0.0], [interaction.c_star], "s", color=VERMILLION, markersize=5)
    _note(ax, f"wall: $c^* = {interaction.c_star:.1f}$", (0.0, interaction.c_star), (12, -4))
    inset_axes = ax.inset_axes((0.47, 0.40, 0.5, 0.5))
    is_shown = x > 0.9 * interaction.d
    inset_axes.plot(x[is_shown], psi[is_shown], color=BLUE, linestyle="-")
    for radius, value, name in ((interaction.d, 0.0, "well"), (interaction.r, rim, f"rim: {rim:.3f}")):
        inset_axes.plot([radius], [value], "o", color=VERMILLION, markersize=4)
        _note(inset_axes, name, (radius, value), (4, 6), fontsize=8)
    inset_axes.set(xlim=(0.93 * interaction.d, 1.14 * interaction.r), ylim=(-0.1 * rim, 1.6 * rim))
    inset_axes.tick_params(labelsize=7)
    return finish(ax, "distance of the pair (length)", "$\\psi_\\alpha$ (energy)")


def target_pull(*, ax: Any = None) -> Any:
    """Draw a γ-agent, five agents, their centre, and the pull on each, which grows with the distance."""
    ax = _plain(ensure_axes(ax))
    q = np.array([[0.0, 0.0], [1.6, 0.3], [0.7, 1.5], [-0.6, 1.2], [0.9, -1.2]])
    target, velocity = np.array([4.6, 1.4]), np.array([1.0, 0.5])
    for item in q:
        _arrow(ax, item, item + 0.3 * (target - item), BLUE, "-")
    ax.scatter(*q.T, s=36, color=INK, zorder=3)
    ax.plot(*q.mean(axis=0), "x", color=VERMILLION, markersize=9, markeredgewidth=2.2, zorder=4)
    _note(ax, "$q_c$", q.mean(axis=0), (-6, 8), color=VERMILLION)
    ax.plot(*target, "^", color=GREEN, markersize=11, zorder=4)
    _arrow(ax, target, target + velocity, GREEN, "-")
    _note(ax, "γ-agent $q_r$", target, (-10, -18), color=GREEN)
    _note(ax, "$p_r$", target + velocity, (3, 2), color=GREEN)
    _note(ax, "$-c_1^\\gamma(q_i-q_r)$", q[2] + 0.25 * (target - q[2]), (-4, 10), color=BLUE)
    ax.set(xlim=(-1.4, 6.4), ylim=(-2.0, 2.9))
    return ax


def projections(*, axes: Any) -> Any:
    """Draw the β-agent of an agent beside a sphere and beside a wall, with the velocities of both, on two axes."""
    sphere, wall = (_plain(ax) for ax in axes)
    centre, radius, q, p = np.zeros(2), 1.0, np.array([1.7, 1.3]), np.array([-1.3, 0.2])
    unit = (q - centre) / np.hypot(*(q - centre))
    share = radius / np.hypot(*(q - centre))
    sphere.fill(*(radius * np.array([np.cos(_CIRCLE), np.sin(_CIRCLE)])), color=FAINT)
    _agent_and_image(sphere, q, p, centre + share * (q - centre), share * (p - unit * (unit @ p)))
    sphere.plot(*np.array([centre, q]).T, color=MUTED, linestyle=":", linewidth=1.0)
    _note(sphere, "$y$", centre, (-12, -4))
    sphere.set(xlim=(-1.3, 3.0), ylim=(-1.2, 2.4))
    write_title(sphere, "sphere: $\\hat p = \\mu P p$")
    q, p = np.array([0.0, 1.3]), np.array([1.2, -0.8])
    wall.fill_between([-1.6, 2.6], -0.8, 0.0, color=FAINT)
    _agent_and_image(wall, q, p, np.array([0.0, 0.0]), np.array([p[0], 0.0]))
    wall.plot([0.0, 0.0], [0.0, 1.3], color=MUTED, linestyle=":", linewidth=1.0)
    wall.set(xlim=(-1.6, 2.6), ylim=(-0.8, 2.2))
    write_title(wall, "wall: $\\hat p = P p$")
    return axes


def _agent_and_image(ax: Any, q: Any, p: Any, image: Any, image_p: Any) -> None:
    _arrow(ax, q, q + p, BLUE, "-")
    _arrow(ax, image, image + image_p, VERMILLION, "-")
    ax.plot(*q, "o", color=BLUE, markersize=7)
    ax.plot(*image, "D", color=VERMILLION, markersize=6)
    _note(ax, "$q_i$", q, (6, 3), color=BLUE)
    _note(ax, "$p_i$", q + p, (6, -4) if p[0] > 0.0 else (-14, 4), color=BLUE)
    _note(ax, "$\\hat q_{ik}$", image, (-4, -16), color=VERMILLION)
    _note(ax, "$\\hat p_{ik}$", image + image_p, (4, 4), color=VERMILLION)


def zones(radii: Mapping[str, float], *, ax: Any = None) -> Any:
    """Draw nested zones about an agent, the widest first; radii by name of the zone."""
    ax = _plain(ensure_axes(ax))
    ordered = sorted(radii.items(), key=lambda each: -each[1])
    most = ordered[0][1]
    for k, (name, radius) in enumerate(ordered):
        grey, height = 0.95 - 0.3 * k / len(ordered), most * (0.9 - 0.4 * k)
        ax.fill(radius * np.cos(_CIRCLE), radius * np.sin(_CIRCLE), facecolor=str(grey), edgecolor=INK, linewidth=0.8)
        angle = 0.9 - 0.35 * k
        at = radius * np.array([np.cos(angle), np.sin(angle)])
        plot_style = {"arrowstyle": "-", "color": INK, "linewidth": 0.7}
        ax.annotate(f"{name} = {radius:g}", at, (1.15 * most, height), fontsize=8, va="center", arrowprops=plot_style)
    ax.plot(0.0, 0.0, "o", color=INK, markersize=6)
    ax.set(xlim=(-1.1 * most, 2.6 * most), ylim=(-1.1 * most, 1.2 * most))
    return ax


def three_orbits(interaction: Any, *, ax: Any = None) -> Any:
    """Draw undamped motions of a pair: one below, one on and one above the energy at which it leaves the range."""
    from scipy.optimize import brentq

    ax = ensure_axes(ax)
    rim = float(interaction.psi_alpha(interaction.r_alpha))

    def above(x: Any, energy: float) -> Any:
        return interaction.psi_alpha(interaction.sigma_norm(x)) - energy

    orbit_styles = [(0.5, BLUE, "-", "0.5 of the rim: it swings"), (1.0, INK, "--", "the rim: separatrix")]
    orbit_styles.append((1.6, VERMILLION, "-.", "1.6 of the rim: it leaves"))
    for share, colour, dash, name in orbit_styles:
        nearest = brentq(above, 0.5 * interaction.d, interaction.d, args=(share * rim,), xtol=1e-13)
        swings = share < 1.0  # else it ends at the range, or leaves
        end = brentq(above, interaction.d, interaction.r, args=(share * rim,), xtol=1e-13) if swings else interaction.r
        end = 1.3 * end if share > 1.0 else end
        x = nearest + (end - nearest) * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 400)))  # dense where it turns
        rate = 2.0 * np.sqrt(np.clip(-above(x, share * rim), 0.0, None))
        ax.plot([*x[::-1], *x], [*-rate[::-1], *rate], color=colour, linestyle=dash, label=name)
        peak_index = int(np.argmax(rate))
        _arrow(ax, (x[peak_index], rate[peak_index]), (x[peak_index + 4], rate[peak_index + 4]), colour, "-")
        _arrow(ax, (x[peak_index], -rate[peak_index]), (x[peak_index - 4], -rate[peak_index - 4]), colour, "-")
    ax.axvline(interaction.r, color=MUTED, linestyle=":", linewidth=1.0)
    _note(ax, "r", (interaction.r, ax.get_ylim()[0]), (3, 4), color=MUTED)
    ax.plot([interaction.d], [0.0], "o", color=INK, markersize=4)
    return finish(ax, "distance of the pair (length)", "its rate (length/time)")


def orbit_ball_level(*, ax: Any = None) -> Any:
    """Draw an orbit of equilibria, the states within a distance of it, a level set inside, and a solution."""
    ax = _plain(ensure_axes(ax))
    circle_points, thick = np.array([np.cos(_CIRCLE), np.sin(_CIRCLE)]), 0.45
    ax.fill(*((1.0 + thick) * circle_points), color="0.88")
    ax.fill(*((1.0 - thick) * circle_points), color="white")
    for radius, label in ((1.0 + 0.6 * thick, "level set of the energy"), (1.0 - 0.6 * thick, None)):
        ax.plot(*(radius * circle_points), color=VERMILLION, linestyle="--", label=label)
    ax.plot(*circle_points, color=BLUE, linestyle="-", linewidth=2.2, label="orbit of equilibria")
    t = np.linspace(0.0, 1.0, 300)
    away = 0.24 * np.exp(-4.0 * t) * np.cos(22.0 * t)
    angle = 0.6 + 0.9 * (1.0 - np.exp(-3.0 * t))
    ax.plot((1.0 + away) * np.cos(angle), (1.0 + away) * np.sin(angle), color=INK, linestyle="-", label="a solution")
    ax.annotate("", (1.0 + thick, 0.0), (1.0, 0.0), arrowprops={"arrowstyle": "<->", "color": INK})
    _note(ax, "$\\xi_0$", (1.0 + thick, 0.0), (4, -4))
    ax.set(xlim=(-1.6, 1.9), ylim=(-1.6, 1.6))
    return finish(ax)


def equilibria(*, axes: Any) -> Any:
    """Draw the potentials about a minimum, a saddle and a degenerate valley on three axes, with descents."""
    x = np.linspace(-1.5, 1.5, 121)
    X, Y = np.meshgrid(x, x)
    kinds = {"minimum: eigenvalues 2, 3": (2.0, 3.0), "saddle: eigenvalues 2, −1": (2.0, -1.0)}
    kinds["degenerate: eigenvalues 2, 0"] = (2.0, 0.0)
    for ax, (name, (a, b)) in zip(axes, kinds.items(), strict=True):
        ax.contour(X, Y, 0.5 * (a * X**2 + b * Y**2), levels=9, colors=MUTED, linewidths=0.8)
        t = np.linspace(0.0, 3.0, 100)
        for start, colour in (((1.2, 0.3), BLUE), ((-1.1, -0.35), VERMILLION)):
            ax.plot(start[0] * np.exp(-a * t), start[1] * np.exp(-b * t), color=colour, linestyle="-")
            ax.plot(*start, "o", color=colour, markersize=4, markerfacecolor="white")
        ax.plot(0.0, 0.0, "k*", markersize=8)
        ax.set(xlim=(-1.5, 1.5), ylim=(-1.5, 1.5), aspect="equal")
        write_title(ax, name)
        finish(ax, "first coordinate", "second coordinate")
    return axes


def held_at_a_jump(*, axes: Any) -> Any:
    """Draw a force that jumps, with Filippov's values at the jump, and a damped motion in the phase plane."""
    (force, plane), (repulsion, pull, k2) = axes, (1.0, 0.4, 0.12)
    for ends, value, name, label_offset in (((-1.0, 0.0), repulsion, "repulsion", -12), ((0.0, 1.0), -pull, "pull", 5)):
        force.plot(ends, (value, value), color=BLUE, linestyle="-")
        force.plot(0.0, value, "o", color=BLUE, markerfacecolor="white", markersize=5, zorder=3)
        _note(force, name, (ends[0] + 0.25, value), (0, label_offset), fontsize=8)
    force.plot((0.0, 0.0), (-pull, repulsion), color=VERMILLION, linestyle="--", label="Filippov: any of these")
    force.plot(0.0, 0.0, "o", color=VERMILLION, label="held: the force 0")
    y, rate, path = 0.0, 0.9, []
    for _ in range(16_000):
        rate += 2e-3 * ((repulsion if y < 0.0 else -pull) - 2.0 * k2 * rate)
        y += 2e-3 * rate
        path.append((y, rate))
    plane.plot(*np.transpose(path), color=INK, linestyle="-", linewidth=0.9)
    plane.plot(0.0, 0.0, "o", color=VERMILLION)
    plane.axvline(0.0, color=VERMILLION, linestyle="--", linewidth=1.0)
    finish(plane, "distance less $d_1$", "its rate")
    return finish(force, "distance less $d_1$", "acceleration of the distance")


def crossing_links(*, ax: Any = None) -> Any:
    """Draw two crossing links of length 1: two of their ends are within 1/√2 of each other."""
    ax = _plain(ensure_axes(ax))
    q = np.array([[-0.5, -0.05], [0.5, 0.05], [0.1, -0.55], [0.02, 0.446]])
    for pair, colour, dash in (((0, 1), BLUE, "-"), ((2, 3), VERMILLION, "--")):
        ax.plot(*q[list(pair)].T, color=colour, linestyle=dash, linewidth=2.0)
    for a, b in ((0, 2), (2, 1), (1, 3), (3, 0)):
        ax.plot(*q[[a, b]].T, color=MUTED, linestyle=":", linewidth=1.0)
        label = f"{np.hypot(*(q[a] - q[b])):.2f}"
        ax.text(*q[[a, b]].mean(axis=0), label, fontsize=8, ha="center", backgroundcolor="white")
    ax.scatter(*q.T, s=40, color=INK, zorder=3)
    ax.set(xlim=(-0.8, 0.8), ylim=(-0.75, 0.65))
    return ax


def interval_tails(k: int, runs: int, interval: tuple[float, float], *, axes: Any) -> Any:
    """Draw the numbers of successes at both ends of the Clopper-Pearson interval on two axes, the tails filled."""
    from scipy.stats import binom

    counts = np.arange(runs + 1)
    for ax, p, tail, words, colour in zip(
        axes, interval, (counts >= k, counts <= k), ("or more", "or fewer"), (BLUE, VERMILLION), strict=True
    ):
        mass = binom.pmf(counts, runs, p)
        ax.bar(counts, mass, color="none", edgecolor=colour, width=0.8)
        ax.bar(counts[tail], mass[tail], color=colour, edgecolor=INK, hatch="//", width=0.8)
        caption = f"filled: {k} {words}, {mass[tail].sum():.1%}"
        ax.text(0.03, 0.9, caption, transform=ax.transAxes, fontsize=8, color=INK)
        ax.set_xlim(max(-1, k - 0.3 * runs), min(runs, k + 0.3 * runs) + 1)
        ax.xaxis.get_major_locator().set_params(integer=True)
        write_title(ax, f"success with probability {p:.3f}")
        finish(ax, f"successes in {runs} runs", "probability")
    return axes


def _arrow(ax: Any, start: Any, end: Any, colour: str, dash: str, *, width: float = 1.4) -> None:
    look = {"arrowstyle": "-|>", "color": colour, "linewidth": width, "linestyle": dash, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", end, start, arrowprops=look)


def _note(ax: Any, text: str, at: Any, offset: tuple[int, int], **look: Any) -> None:
    ax.annotate(text, at, offset, textcoords="offset points", **look)


def _plain(ax: Any) -> Any:
    ax.set_aspect("equal")
    ax.set_axis_off()
    return ax
