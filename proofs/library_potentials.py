"""The library's potentials are the proved integrals: how far its polynomials are from ψ_α and ψ_β, at every distance.

On each panel the slope of the polynomial less the action is expanded in Chebyshev polynomials, whose coefficients bound
it everywhere; what the expansion leaves out is bounded by Cauchy's estimate. Numbers of the library count with their
binary values. What is left is the rounding of an evaluation, some units in the last place of the largest summand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import comb
from typing import Any

from flint import acb, arb, arb_series, ctx

from flockana.certified.balls import AlphaParameters, BetaParameters, ball, series_length, square
from flockana.certified.decimal_rounding import small
from flockana.certified.scalar_functions_in_balls import (
    c_star,
    d_alpha,
    d_beta,
    far_potential,
    psi_alpha,
    psi_beta,
    r_alpha,
    shift,
)
from flockana.interactions import AlphaInteraction, BetaInteraction
from flockana.kernels import alpha as kernel
from proofs.enclosures import parameter_sets
from proofs.proof import Proof, Step

DIGITS = 80
TERMS = 140  # of the expansion about the middle of a panel
RADIUS = arb("1.5")  # of the circle on which it is bounded, in half widths of the panel
ARCS = 256
STATED = {"error": "1e-15"}  # in units of c*; the panels themselves may hang on the processor, in their last places

Series = Any  # an arb_series, or an acb of an arc
Action = Callable[[Series], Series]


def alpha_action(par: AlphaParameters) -> Action:
    """φ_α on the taper, continued beyond its ends, of series and of complex balls."""
    a, b, first, cutoff, h = ball(par.a), ball(par.b), d_alpha(par), r_alpha(par), ball(par.h)
    c = shift(par.a, par.b)

    def action(z: Series) -> Series:
        s = z - first + c
        return (1 + ((z / cutoff - h) / (1 - h)).cos_pi()) / 2 * ((a + b) * s * _root(1 + s * s) + (a - b)) / 2

    return action


def beta_action(par: BetaParameters) -> Action:
    """φ_β likewise."""
    cutoff, h = d_beta(par), ball(par.h)

    def action(z: Series) -> Series:
        s = z - cutoff
        return (1 + ((z / cutoff - h) / (1 - h)).cos_pi()) / 2 * (s * _root(1 + s * s) - 1)

    return action


def _root(x: Series) -> Series:
    """1/√x; nan where a complex ball meets the cut, which reaches from the branch point to infinity."""
    return x.rsqrt(analytic=True) if isinstance(x, acb) else x.rsqrt()


def on_circle(action: Action, middle: arb, half: arb) -> arb:
    """A bound of |action| on the disc, by its circle: an analytic function is largest there."""
    width = (arb.pi() / ARCS).upper() * RADIUS
    largest = arb(0)
    for k in range(ARCS):
        centre = RADIUS * acb(0, 2 * arb.pi() * k / ARCS).exp()
        arc = acb(arb(centre.real.mid(), width), arb(centre.imag.mid(), width))
        largest = largest.max(abs(action(middle + half * arc)))
    return largest


def chebyshev(powers: list[arb]) -> list[arb]:
    """Coefficients of the same polynomial in Chebyshev's: x^k = 2^(1-k) Σ' binom(k, (k - j)/2) T_j."""
    out = [arb(0)] * len(powers)
    for k, coefficient in enumerate(powers):
        for j in range(k % 2, k + 1, 2):
            part = coefficient * comb(k, (k - j) // 2) / arb(2) ** (k - 1)
            out[j] += part / 2 if j == 0 else part
    return out


def slope_error(row: Any, action: Action) -> arb:
    """A bound of |dP/dz - action| on a panel, both of z within it."""
    left, right, *coefficients = (arb(float(x)) for x in row)
    middle, half = (left + right) / 2, (right - left) / 2
    with series_length(TERMS):
        expansion = list(action(arb_series([middle, half])))
    slope = [k * c / half for k, c in enumerate(coefficients)][1:]
    slope += [arb(0)] * (TERMS - len(slope))
    expansion += [arb(0)] * (TERMS - len(expansion))
    difference = [s - e for s, e in zip(slope, expansion, strict=True)]
    rest = on_circle(action, middle, half) * RADIUS ** (-TERMS) / (1 - 1 / RADIUS)
    return sum((abs(c) for c in chebyshev(difference)), arb(0)) + rest


def panels_error(panels: Any, action: Action, potential: Callable[[arb], arb], ends: arb) -> arb:
    """A bound of |P - ψ| on all panels; `ends` bounds what the continued action adds at the ends of the taper."""
    worst = arb(0)
    for row in panels:
        left, right, *coefficients = (arb(float(x)) for x in row)
        at_left = sum((c * (-1) ** k for k, c in enumerate(coefficients)), arb(0))
        start = abs(at_left - potential(left))
        worst = worst.max(start + (right - left) * (slope_error(row, action) + ends))
    return worst


def taper_ends(knee: arb, cutoff: arb, panels: Any, largest: arb) -> arb:
    """|continued taper - taper| times the largest action: within rounding of its ends they differ by (½π t)²."""
    off = max(abs(arb(float(panels[0, 0])) - knee), abs(arb(float(panels[-1, 1])) - cutoff)) / (cutoff - knee)
    return square(arb.pi() / 2 * off) * largest


def alpha_error(par: AlphaParameters, alpha: AlphaInteraction) -> arb:
    """A bound of |ψ_α of the library - ψ_α| at every z, in units of c*."""
    numbers = [arb(float(x)) for x in alpha.par]
    knee, cutoff, largest = ball(par.h) * r_alpha(par), r_alpha(par), ball(par.a) + ball(par.b)
    ends = taper_ends(knee, cutoff, alpha.panels, largest)
    tapered = panels_error(alpha.panels, alpha_action(par), lambda z: psi_alpha(z, par), ends)
    # where ρ_h = 1 it is ½(a + b)[√(1 + (s + c)²) - √(1 + c²) - σ₁(c) s] + constant, with d_α and c rounded
    a, b, c, first = (numbers[k] for k in (kernel.A, kernel.B, kernel.C, kernel.D_ALPHA))
    s = arb(float(alpha.panels[0, 0])) - first
    root = (1 + square(c)).sqrt()
    closed = (a + b) / 2 * ((1 + square(s + c)).sqrt() - root - c / root * s) + numbers[kernel.OFFSET]
    at_knee = abs(closed - psi_alpha(arb(float(alpha.panels[0, 0])), par))
    rounded = abs(first - d_alpha(par)) + 2 * abs(c - shift(par.a, par.b))
    before = at_knee + knee * (largest / 2 * rounded + ends)
    beyond = abs(numbers[kernel.FAR] - far_potential(par))
    return max(tapered, before, beyond, key=lambda x: x.upper()) / c_star(par)


def beta_error(par: BetaParameters, beta: BetaInteraction) -> arb:
    """A bound of |ψ_β of the library - ψ_β| at every z, in units of ψ_β(0)."""
    numbers = [arb(float(x)) for x in beta.par]
    cutoff = d_beta(par)
    knee = ball(par.h) * cutoff
    ends = taper_ends(knee, cutoff, beta.panels, arb(2))
    tapered = panels_error(beta.panels, beta_action(par), lambda z: psi_beta(z, par), ends)
    z = arb(float(beta.panels[0, 0]))
    s = z - numbers[kernel.D_BETA]
    closed = (1 + square(s)).sqrt() - 1 - z + numbers[kernel.BETA_OFFSET]
    at_knee = abs(closed - psi_beta(z, par))
    before = at_knee + knee * (abs(numbers[kernel.D_BETA] - cutoff) + ends)
    return max(tapered, before, key=lambda x: x.upper()) / psi_beta(arb(0), par)


def error_of(par: AlphaParameters | BetaParameters) -> arb:
    """That of the interaction with these parameters."""
    values = {name: int(getattr(par, name).p) / int(getattr(par, name).q) for name in par.__dataclass_fields__}
    if isinstance(par, AlphaParameters):
        return alpha_error(par, AlphaInteraction(**values))
    return beta_error(par, BetaInteraction(**values))


def _steps() -> Iterator[Step]:
    with ctx.workdps(DIGITS):
        sets = parameter_sets()
        errors = {par: error_of(par) for par in sets}
        for par, error in errors.items():
            name, unit = ("ψ_α", "c*") if isinstance(par, AlphaParameters) else ("ψ_β", "ψ_β(0)")
            within = bool(error < arb(STATED["error"]))
            yield Step(
                f"{par}: {name} of the library is within {STATED['error']} {unit} of the integral, at every z >= 0",
                within,
                evidence=f"{small(error)} {unit}, before rounding",
                found=STATED if within else {},
            )


PROOF = Proof(
    id="library-potentials",
    title="The library's potentials are the proved integrals",
    statement=(
        f"For the parameters of every scenario ψ_α of the library is within {STATED['error']} c* of the integral of "
        "φ_α, and ψ_β as near in units of ψ_β(0), at every distance, before the rounding of an evaluation."
    ),
    hypotheses="the library's numbers as binary fractions; ℓ = 1, as in the catalogue",
    rigour="interval",
    steps=_steps,
    size=6,
    values=STATED,
)
