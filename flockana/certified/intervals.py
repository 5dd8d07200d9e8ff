"""The scalar functions of flocking in ball arithmetic (Arb), as the checkers of certificates compute them.

Every result encloses the true values on all of a ball (`flockana.certified.balls`). They are written by hand, and
share nothing with what proves: that is generated (`flockana.certified.formulas`).
"""

from __future__ import annotations

from functools import cache
from typing import Any

from flint import acb, arb, ctx

from flockana.certified.balls import AlphaParameters, BetaParameters, ball, clamp, hull, monotone, square


def sigma_of_square(s: arb, eps: Any) -> arb:
    """Return ‖x‖_σ as a function of s = ‖x‖² >= 0, without cancellation at small s."""
    s = ball(s).nonnegative_part()
    return monotone(lambda s: s / ((1 + ball(eps) * s).sqrt() + 1), s)


def sigma_norm(x: arb, eps: Any) -> arb:
    """Return ‖x‖_σ = (√(1 + ε x²) − 1)/ε of a Euclidean length."""
    return sigma_of_square(square(ball(x)), eps)


def sigma_1(s: arb) -> arb:
    """Return s/√(1 + s²), increasing."""
    return monotone(lambda s: s * (1 + square(s)).rsqrt(), ball(s))


def sigma_1_slope(s: arb) -> arb:
    """Return (1 + s²)^(−3/2)."""
    root = (1 + square(ball(s))).rsqrt()
    return root * root * root


def bump(z: arb, h: Any) -> arb:
    """Return ρ_h(z) for z >= 0, 0 < h < 1, nonincreasing."""
    return monotone(lambda z: (1 + (clamp((z - ball(h)) / (1 - ball(h)))).cos_pi()) / 2, ball(z))


def bump_slope(z: arb, h: Any) -> arb:
    """Return ρ_h'(z), continuous: −π sin(π (z − h)/(1 − h))/(2 (1 − h)) on [h, 1], 0 elsewhere."""
    rest = 1 - ball(h)
    return -arb.pi() / (2 * rest) * clamp((ball(z) - ball(h)) / rest).sin_pi()


def shift(a: Any, b: Any) -> arb:
    """Return c = |a − b|/√(4ab), which makes φ(0) = 0."""
    return (ball(b) - ball(a)) / (4 * ball(a) * ball(b)).sqrt()


def phi(s: arb, a: Any, b: Any) -> arb:
    """Return φ(s) = ½[(a+b) σ₁(s+c) + (a−b)], increasing."""
    return ((ball(a) + ball(b)) * sigma_1(ball(s) + shift(a, b)) + ball(a) - ball(b)) / 2


def phi_slope(s: arb, a: Any, b: Any) -> arb:
    """Return φ'(s) > 0."""
    return (ball(a) + ball(b)) / 2 * sigma_1_slope(ball(s) + shift(a, b))


def d_alpha(par: AlphaParameters) -> arb:
    """Return ‖d‖_σ."""
    return sigma_norm(ball(par.d), par.eps)


def r_alpha(par: AlphaParameters) -> arb:
    """Return ‖r‖_σ."""
    return sigma_norm(ball(par.r), par.eps)


def adjacency(z: arb, par: AlphaParameters) -> arb:
    """Return a_ij = ρ_h(z/r_α)."""
    return bump(ball(z) / r_alpha(par), par.h)


def phi_alpha(z: arb, par: AlphaParameters) -> arb:
    """Return φ_α(z) = ρ_h(z/r_α) φ(z − d_α)."""
    return adjacency(z, par) * phi(ball(z) - d_alpha(par), par.a, par.b)


def phi_alpha_slope(z: arb, par: AlphaParameters) -> arb:
    """Return dφ_α/dz, continuous."""
    x, s, cutoff = ball(z) / r_alpha(par), ball(z) - d_alpha(par), r_alpha(par)
    falling = bump_slope(x, par.h) / cutoff * phi(s, par.a, par.b)
    return falling + bump(x, par.h) * phi_slope(s, par.a, par.b)


def psi_alpha(z: arb, par: AlphaParameters) -> arb:
    """Return ψ_α(z) = ∫_{d_α}^{z} φ_α for z >= 0: decreasing to d_α, increasing to r_α, constant beyond.

    Closed form where ρ_h = 1; on the taper the integral is enclosed by Arb.
    """
    z, zero = ball(z).nonnegative_part(), d_alpha(par)
    if z.is_exact():
        return _psi_alpha(z, par)
    if z <= zero or z >= zero:
        return monotone(lambda z: _psi_alpha(z, par), z)
    return hull(arb(0), _psi_alpha(z.lower(), par), _psi_alpha(z.upper(), par))


def _psi_alpha(z: arb, par: AlphaParameters) -> arb:
    """Return ψ_α at a point."""
    at_zero, at_cutoff = _alpha_levels(par, ctx.prec)
    return (at_cutoff if z >= r_alpha(par) else _alpha_from_knee(z, par)) - at_zero


@cache
def _alpha_levels(par: AlphaParameters, prec: int) -> tuple[arb, arb]:
    """Return the integrals of φ_α from h r_α to d_α and to r_α (cached by precision)."""
    return _alpha_from_knee(d_alpha(par), par), _alpha_from_knee(r_alpha(par), par)


def _alpha_from_knee(z: arb, par: AlphaParameters) -> arb:
    """Return the integral of φ_α from h r_α to z: closed form before, enclosed by Arb after."""
    cutoff = r_alpha(par)
    knee = ball(par.h) * cutoff
    before = arb(0) if z >= knee else _alpha_closed(z.min(knee), par) - _alpha_closed(knee, par)
    after = arb(0) if z <= knee else _alpha_taper(knee, z.max(knee).min(cutoff), par)
    return before + after


def _alpha_closed(z: arb, par: AlphaParameters) -> arb:
    """Return an antiderivative of φ(z − d_α)."""
    a, b, s = ball(par.a), ball(par.b), z - d_alpha(par) + shift(par.a, par.b)
    return ((a + b) * (1 + square(s)).sqrt() + (a - b) * z) / 2


def _alpha_taper(low: arb, high: arb, par: AlphaParameters) -> arb:
    """Return the integral of φ_α between two points of the taper."""
    a, b, h, cutoff = ball(par.a), ball(par.b), ball(par.h), r_alpha(par)
    offset = shift(par.a, par.b) - d_alpha(par)

    def integrand(z: acb, analytic: bool) -> acb:
        s = z + offset
        action = (a + b) * s * (1 + s * s).rsqrt(analytic=analytic) + (a - b)
        return (1 + ((z / cutoff - h) / (1 - h)).cos_pi()) * action / 4

    return acb.integral(integrand, low, high).real


def c_star(par: AlphaParameters) -> arb:
    """Return c* = ψ_α(0), the energy of a coincident pair (without the gain c1α)."""
    return psi_alpha(arb(0), par)


def far_potential(par: AlphaParameters) -> arb:
    """Return ψ_α(r_α), the part of V of every pair out of range."""
    return psi_alpha(r_alpha(par), par)


def d_beta(par: BetaParameters) -> arb:
    """Return ‖d'‖_σ."""
    return sigma_norm(ball(par.d), par.eps)


def phi_beta(z: arb, par: BetaParameters) -> arb:
    """Return φ_β(z) = ρ_h(z/d_β)(σ₁(z − d_β) − 1)."""
    return bump(ball(z) / d_beta(par), par.h) * (sigma_1(ball(z) - d_beta(par)) - 1)


def phi_beta_slope(z: arb, par: BetaParameters) -> arb:
    """Return dφ_β/dz, continuous."""
    x, s = ball(z) / d_beta(par), ball(z) - d_beta(par)
    falling = bump_slope(x, par.h) / d_beta(par) * (sigma_1(s) - 1)
    return falling + bump(x, par.h) * sigma_1_slope(s)


def psi_beta(z: arb, par: BetaParameters) -> arb:
    """Return ψ_β(z) = ∫_{d_β}^{z} φ_β for z >= 0: decreasing to d_β, 0 beyond."""
    return monotone(lambda z: _psi_beta(z, par), ball(z).nonnegative_part())


def _psi_beta(z: arb, par: BetaParameters) -> arb:
    """Return ψ_β at a point."""
    cutoff = d_beta(par)
    if z >= cutoff:
        return arb(0)
    knee = ball(par.h) * cutoff
    before = arb(0) if z >= knee else _beta_closed(z.min(knee) - cutoff) - _beta_closed(knee - cutoff)
    return before + _beta_taper(z.max(knee).min(cutoff), par)


def _beta_closed(s: arb) -> arb:
    """Return an antiderivative of σ₁(s) − 1."""
    return (1 + square(s)).sqrt() - s


def _beta_taper(low: arb, par: BetaParameters) -> arb:
    """Return the integral of −φ_β from a point of the taper to its end."""
    h, cutoff = ball(par.h), d_beta(par)

    def integrand(z: acb, analytic: bool) -> acb:
        s = z - cutoff
        return (1 + ((z / cutoff - h) / (1 - h)).cos_pi()) * (1 - s * (1 + s * s).rsqrt(analytic=analytic)) / 2

    return acb.integral(integrand, low, cutoff).real
