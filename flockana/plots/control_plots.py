"""Control-engineering plots: Bode, Nyquist, singular values, root locus, gain sweep, norms by size, delay margins."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.ticker import MultipleLocator, NullFormatter

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError, format_value
from flockana.plots.palette import BLUE, FAINT, GREEN, INK, MUTED, PURPLE, VERMILLION
from flockana.plots.style import ensure_axes, finish, hairlines, line_width_and_opacity, mark, style
from flockana.plots.symbol_typesetting import typeset

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flockana.stability.gain_sweeps import MarginSweep, Sweep
    from flockana.stability.law_studies import NormTable

_DASHES = ((BLUE, "-"), (VERMILLION, "--"), (GREEN, "-."), (PURPLE, ":"))
_NAMES = {"c1_alpha": "c1α", "c2_alpha": "c2α", "c1_gamma": "c1γ", "c2_gamma": "c2γ"}
_UNITS = {"c1": "1/time²", "c2": "1/time"}


@check_kinds
def bode(responses: Mapping[str, Any], *, marks: Mapping[str, float] | None = None, ax: Any = None) -> Any:
    """Draw magnitude (decibels) and phase of frequency responses, one above the other.

    Parameters
    ----------
    responses : mapping of str to control.FrequencyResponseData
        By label, such as those of `Linearisation.response`, or what has `omega` and `complex` as they have. Of one with
        several inputs or outputs each pair is drawn, labelled by its signals.
    marks : mapping of str to float, optional
        Frequencies to point out, by label.
    ax : sequence of two Axes, optional
        Where to draw magnitude and phase; by default a new figure.

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (2,)
    """
    curves = [curve for label, response in responses.items() for curve in _curves(label, response)]
    if ax is None:
        import matplotlib.pyplot as plt

        with style():
            ax = plt.subplots(2, 1, figsize=(5.2, 4.6), sharex=True)[1]
    magnitude, phase = panels = np.ravel(ax)
    for curve, plot_style in zip(curves, _looks(), strict=False):
        with np.errstate(divide="ignore"):  # what answers nothing has no place on the axis
            magnitude.semilogx(curve.omega, 20.0 * np.log10(np.abs(curve.values)), label=curve.label, **plot_style)
        phase.semilogx(curve.omega, np.degrees(np.unwrap(np.angle(curve.values))), **plot_style)
    for name, omega in (marks or {}).items():
        mark(magnitude, omega, name, width=0.9, color=MUTED, fontsize=8)
        mark(phase, omega, width=0.9)
    magnitude.axhline(0.0, color=FAINT, linewidth=1.2, linestyle="-", zorder=0)
    ratios = {curve.ratio for curve in curves}
    finish(magnitude, y=f"|{ratios.pop()}| (dB)" if len(ratios) == 1 else "magnitude (dB)")
    finish(phase, "ω (radians/time)", "phase (degrees)")
    phase.yaxis.set_major_locator(MultipleLocator(45.0))
    return panels


class _Curve(NamedTuple):
    """One scalar frequency response: label, output over input, frequencies and values."""

    label: str
    ratio: str
    omega: Any
    values: Any


def _curves(label: str, response: Any) -> list[_Curve]:
    """Return the scalar frequency responses from each input to each output of a multivariable response."""
    if not (hasattr(response, "omega") and hasattr(response, "complex")):
        what = f"responses[{label!r}] = {format_value(response)}"
        raise ArgumentError(f"{what}: expected a frequency response, as of Linearisation.response or CentreOfMass")
    omega = np.ravel(response.omega)
    values = np.reshape(response.complex, (-1, omega.size))
    inputs, outputs = (list(getattr(response, f"{way}_labels", None) or ["?"]) for way in ("input", "output"))
    if len(values) == 1:
        ratio = "G" if "?" in (outputs[0], inputs[0]) else f"{outputs[0]}/{inputs[0]}"
        return [_Curve(label, ratio, omega, values[0])]
    pairs = [f"{outputs[k // len(inputs)]}/{inputs[k % len(inputs)]}" for k in range(len(values))]
    return [_Curve(f"{label}: {pair}", pair, omega, row) for pair, row in zip(pairs, values, strict=True)]


def _looks() -> Iterator[dict[str, Any]]:
    """Yield line styles without end: four that differ in colour and dash, then other combinations."""
    for style_number in count():
        for k, (colour, _) in enumerate(_DASHES):
            yield {"color": colour, "linestyle": _DASHES[(k + style_number) % len(_DASHES)][1]}


@check_kinds
def nyquist(responses: Mapping[str, Any], *, ax: Axes | None = None) -> Axes:
    """Draw open loops L(jω) in the complex plane, for ω > 0 and dashed for ω < 0, about the point −1.

    Parameters
    ----------
    responses : mapping of str to control.FrequencyResponseData
        By label, such as frequency responses of `flockana.stability.open_loop`. What is farther than twice the distance
        that matters is cut off.
    """
    ax = ensure_axes(ax)
    angle, farthest = np.linspace(0.0, 2.0 * np.pi, 181), 1.5
    curves = [curve for label, response in responses.items() for curve in _curves(label, response)]
    for curve, plot_style in zip(curves, _looks(), strict=False):
        ax.plot(curve.values.real, curve.values.imag, color=plot_style["color"], linestyle="-", label=curve.label)
        ax.plot(curve.values.real, -curve.values.imag, color=plot_style["color"], linestyle="--", linewidth=0.8)
        magnitudes = np.abs(curve.values)
        farthest = max(farthest, min(4.0, 1.1 * float(magnitudes.max(initial=0.0))))
    ax.plot(np.cos(angle), np.sin(angle), color=FAINT, linestyle="-", linewidth=0.9, zorder=0)
    ax.plot(-1.0, 0.0, "+", color=VERMILLION, markersize=9, markeredgewidth=1.6, linestyle="none", label="−1")
    ax.axhline(0.0, color=MUTED, linewidth=0.6, linestyle="-", zorder=0)
    ax.axvline(0.0, color=MUTED, linewidth=0.6, linestyle="-", zorder=0)
    ax.set(xlim=(-farthest, farthest), ylim=(-farthest, farthest), aspect="equal")
    return finish(ax, "Re L(jω)", "Im L(jω)")


@check_kinds
def singular_values(response: Any, *, ax: Axes | None = None) -> Axes:
    """Draw the singular values of a frequency response with several inputs and outputs over frequency, in decibels.

    Parameters
    ----------
    response : control.FrequencyResponseData
        Such as `control.frequency_response(linearisation.structural, omega)`.
    """
    ax = ensure_axes(ax)
    curves = _curves("response", response)
    values = np.moveaxis(np.reshape(response.complex, (response.noutputs, response.ninputs, -1)), -1, 0)
    singular_values = 20.0 * np.log10(np.linalg.svd(values, compute_uv=False))
    plot_style: dict[str, Any] = {"color": MUTED, "linestyle": "-"}
    ax.semilogx(curves[0].omega, singular_values[:, 1:], **plot_style)
    ax.semilogx(curves[0].omega, singular_values[:, 0], **plot_style | {"color": BLUE, "label": "largest"})
    return finish(ax, "ω (radians/time)", "singular values (dB)")


@check_kinds
def root_locus(sweep: Sweep, *, ax: Axes | None = None) -> Axes:
    """Draw branches of eigenvalues in the complex plane: crosses at the least gain, dots at the greatest.

    Parameters
    ----------
    sweep : flockana.stability.gain_sweeps.Sweep
        From `centre_locus` or `gain_sweep`.
    """
    ax = ensure_axes(ax)
    roots = sweep.eigenvalues
    width, alpha = line_width_and_opacity(roots.shape[1])
    ax.plot(roots.real, roots.imag, color=BLUE, linestyle="-", linewidth=max(0.7, width), alpha=max(0.6, alpha))
    name = _NAMES[sweep.name]
    first_label, last_label = f"{name} = {sweep.values[0]:.4g}", f"{name} = {sweep.values[-1]:.4g}"
    ax.plot(roots[0].real, roots[0].imag, "x", color=INK, markersize=5, linestyle="none", label=first_label)
    ax.plot(roots[-1].real, roots[-1].imag, "o", color=VERMILLION, markersize=3.5, linestyle="none", label=last_label)
    ax.axvline(0.0, color=MUTED, linewidth=0.9, linestyle="-", zorder=0)
    return finish(ax, "Re s (1/time)", "Im s (radians/time)")


@check_kinds
def gain_sweep(sweep: Sweep, *, ax: Axes | None = None) -> Axes:
    """Draw the real parts of all eigenvalues over the gain, the largest one in front.

    Parameters
    ----------
    sweep : flockana.stability.gain_sweeps.Sweep
        From `gain_sweep` or `centre_locus`.
    """
    ax = ensure_axes(ax)
    decay = sweep.eigenvalues.real[:, sweep.neutral :]
    hairlines(ax, sweep.values, decay, "every mode", colour=MUTED)
    ax.plot(sweep.values, sweep.abscissa, color=VERMILLION, linestyle="-", linewidth=2.0, label="the slowest")
    ax.axhline(0.0, color=INK, linewidth=0.8, linestyle="-")
    if sweep.neutral:
        ax.plot([], [], linestyle="none", label=f"({sweep.neutral} neutral not shown)")
    ax.set_xlim(sweep.values[0], sweep.values[-1])
    return finish(ax, _gain_label(sweep.name), "Re s (1/time)")


@check_kinds
def norms(table: NormTable, *, ax: Axes | None = None) -> Axes:
    """Draw H₂, between its closed-form bounds, and H∞ against the number of agents, both logarithmic.

    Parameters
    ----------
    table : flockana.stability.norms.NormTable
        From `norms_against_size`.
    """
    ax = ensure_axes(ax)
    n, (low, high) = table.sizes, table.bounds.T
    ax.fill_between(n, low, high, color=BLUE, alpha=0.15, linewidth=0.0, label="bounds of H₂")
    ax.plot(n, table.h2, "o-", color=BLUE, markersize=4, label="H₂ (time^(3/2))")
    ax.plot(n, table.hinf, "s--", color=VERMILLION, markersize=4, label="H∞ (time²)")
    ax.set(xscale="log", yscale="log", xticks=n)
    ax.xaxis.set(major_formatter="{x:g}", minor_formatter=NullFormatter())
    ax.tick_params(axis="x", which="minor", bottom=False)
    return finish(ax, "n, agents", "norm from forces to the shape")


@check_kinds
def delay_chart(sweeps: Mapping[str, MarginSweep], *, ax: Axes | None = None) -> Axes:
    """Draw the delay margin against a gain; below its line the flock is stable.

    Parameters
    ----------
    sweeps : mapping of str to flockana.stability.gain_sweeps.MarginSweep
        By label, over the same gain; four at most. The area below the first is shaded.
    """
    ax = ensure_axes(ax)
    for k, ((label, sweep), (colour, dash)) in enumerate(zip(sweeps.items(), _DASHES, strict=False)):
        if k == 0:
            ax.fill_between(sweep.values, 0.0, sweep.margins, color=BLUE, alpha=0.12, linewidth=0.0)
            ax.set(xlabel=typeset(_gain_label(sweep.name)), xlim=(sweep.values[0], sweep.values[-1]))
        ax.plot(sweep.values, sweep.margins, color=colour, linestyle=dash, label=label)
    ax.text(0.03, 0.05, "stable", transform=ax.transAxes, color=MUTED)
    ax.set_ylim(bottom=0.0)
    return finish(ax, y="τ*, delay margin (time)")


def _gain_label(name: str) -> str:
    return f"{_NAMES[name]} ({_UNITS[name[:2]]})"
