"""Scalar functions of flocking in ball arithmetic (Arb), for the checkers of certificates.

Every result encloses the true values on all of a ball (`flockana.certified.balls`). They are written by hand, and
share nothing with what proves: that is generated (`flockana.certified.formula_in_balls`).
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

from flint import acb, arb, ctx

from flockana.certified.balls import AlphaParameters, BetaParameters, ball, clamp, hull, integrate, monotone, square


def sigma_of_square(s: arb, eps: Any) -> arb:
    """Return ‖x‖_σ as a function of s = ‖x‖² >= 0, without cancellation at small s."""
    s = ball(s).nonnegative_part()
    return monotone(lambda s: s / ((1 + ball(eps) * s).sqrt() + 1), s)


def sigma_norm(x: arb, eps: Any) -> arb:
    """Return ‖x‖_σ = (√(1 + ε x²) − 1)/ε of a Euclidean length."""
    return sigma_of_square(square(ball(x)), eps)


def sigma_1(s: arb) -> arb:
    """Return σ₁(s) = s/√(1 + s²), an increasing function."""
    return monotone(lambda s: s * (1 + square(s)).rsqrt(), ball(s))


def sigma_1_slope(s: arb) -> arb:
    """Return the derivative of σ₁(s), which is (1 + s²)^(−3/2)."""
    root = (1 + square(ball(s))).rsqrt()
    return root * root * root


def bump(z: arb, h: Any) -> arb:
    """Return ρ_h(z) for z >= 0, 0 < h < 1, nonincreasing."""
    return monotone(lambda z: (1 + (clamp((z - ball(h)) / (1 - ball(h)))).cos_pi()) / 2, ball(z))


def bump_slope(z: arb, h: Any) -> arb:
    """Return ρ_h'(z), continuous: −π sin(π (z − h)/(1 − h))/(2 (1 − h)) on [h, 1], 0 elsewhere."""
    taper_width = 1 - ball(h)
    return -arb.pi() / (2 * taper_width) * clamp((ball(z) - ball(h)) / taper_width).sin_pi()


def shift(a: Any, b: Any) -> arb:
    """Return c = |a − b|/√(4ab), which makes φ(0) = 0."""
    return (ball(b) - ball(a)) / (4 * ball(a) * ball(b)).sqrt()


def phi(s: arb, a: Any, b: Any) -> arb:
    """Return φ(s) = ½[(a+b) σ₁(s+c) + (a−b)], increasing."""
    return ((ball(a) + ball(b)) * sigma_1(ball(s) + shift(a, b)) + ball(a) - ball(b)) / 2


def d_alpha(par: AlphaParameters) -> arb:
    """Return d_α = ‖d‖_σ, the σ-norm of the desired distance of two agents."""
    return sigma_norm(ball(par.d), par.eps)


def r_alpha(par: AlphaParameters) -> arb:
    """Return r_α = ‖r‖_σ, the σ-norm of the interaction range of two agents."""
    return sigma_norm(ball(par.r), par.eps)


def adjacency(z: arb, par: AlphaParameters) -> arb:
    """Return the adjacency a_ij = ρ_h(z/r_α) of two agents at a distance of σ-norm z."""
    return bump(ball(z) / r_alpha(par), par.h)


def d_beta(par: BetaParameters) -> arb:
    """Return d_β = ‖d'‖_σ, the σ-norm of the desired clearance d' from obstacles."""
    return sigma_norm(ball(par.d), par.eps)


@dataclass(frozen=True)
class _Action:
    """Pair action ρ_h(z/cutoff)(A σ₁(z + offset) + B) common to the α- and the β-law; zero beyond the cutoff."""

    factor: arb
    level: arb
    offset: arb
    zero: arb
    cutoff: arb
    h: arb

    def at(self, z: arb) -> arb:
        """Return the pair action at a σ-norm z of the distance."""
        return bump(z / self.cutoff, self.h) * self._smooth(z)

    def slope(self, z: arb) -> arb:
        """Return the derivative of the pair action by the σ-norm, which is continuous."""
        x = z / self.cutoff
        rising_slope = self.factor * sigma_1_slope(z + self.offset)
        return bump_slope(x, self.h) / self.cutoff * self._smooth(z) + bump(x, self.h) * rising_slope

    def _smooth(self, z: arb) -> arb:
        return self.factor * sigma_1(z + self.offset) + self.level

    def potential(self, z: arb) -> arb:
        """Return the pair potential at a σ-norm: the integral of the pair action from its zero."""
        if z.is_exact():
            return self._potential(z)
        if z <= self.zero or z >= self.zero:
            return monotone(self._potential, z)
        return hull(arb(0), self._potential(z.lower()), self._potential(z.upper()))

    def _potential(self, z: arb) -> arb:
        """Return the pair potential at one σ-norm of the distance."""
        return (self.at_cutoff if z >= self.cutoff else self._from_knee(z)) - self.at_zero

    @cached_property
    def at_zero(self) -> arb:
        """Return the integral of the pair action from h·cutoff to the zero of the action."""
        return self._from_knee(self.zero)

    @cached_property
    def at_cutoff(self) -> arb:
        """Return the integral of the pair action from h·cutoff to the cutoff."""
        return self._from_knee(self.cutoff)

    def _from_knee(self, z: arb) -> arb:
        """Return the integral of the pair action from h·cutoff to a σ-norm z."""
        knee = self.h * self.cutoff
        inner_part = arb(0) if z >= knee else self._closed(z.min(knee)) - self._closed(knee)
        outer_part = arb(0) if z <= knee else integrate(self._on_taper, knee, z.max(knee).min(self.cutoff))
        return inner_part + outer_part

    def _closed(self, z: arb) -> arb:
        return self.factor * (1 + square(z + self.offset)).sqrt() + self.level * z

    def _on_taper(self, z: acb, analytic: bool) -> acb:
        s = z + self.offset
        action = self.factor * s * (1 + s * s).rsqrt(analytic=analytic) + self.level
        return (1 + ((z / self.cutoff - self.h) / (1 - self.h)).cos_pi()) * action / 2


@cache
def _action(par: AlphaParameters | BetaParameters, prec: int) -> _Action:
    """Return the pair action of a law's parameters at a given precision."""
    if isinstance(par, BetaParameters):
        return _Action(arb(1), arb(-1), -d_beta(par), d_beta(par), d_beta(par), ball(par.h))
    a, b, zero = ball(par.a), ball(par.b), d_alpha(par)
    return _Action((a + b) / 2, (a - b) / 2, shift(par.a, par.b) - zero, zero, r_alpha(par), ball(par.h))


def phi_alpha(z: arb, par: AlphaParameters | BetaParameters) -> arb:
    """Return φ_α(z) = ρ_h(z/r_α) φ(z − d_α)."""
    return _action(par, ctx.prec).at(ball(z))


def phi_alpha_slope(z: arb, par: AlphaParameters | BetaParameters) -> arb:
    """Return dφ_α/dz, continuous."""
    return _action(par, ctx.prec).slope(ball(z))


def psi_alpha(z: arb, par: AlphaParameters | BetaParameters) -> arb:
    """Return ψ_α(z) = ∫_{d_α}^{z} φ_α for z >= 0: decreasing to d_α, increasing to r_α, constant beyond."""
    return _action(par, ctx.prec).potential(ball(z).nonnegative_part())


def c_star(par: AlphaParameters) -> arb:
    """Return c* = ψ_α(0), the energy of a coincident pair (without the gain c1α)."""
    return psi_alpha(arb(0), par)


def far_potential(par: AlphaParameters) -> arb:
    """Return ψ_α(r_α), the part of V of every pair out of range."""
    return psi_alpha(r_alpha(par), par)


# φ_β(z) = ρ_h(z/d_β)(σ₁(z − d_β) − 1), dφ_β/dz, and ψ_β(z) = ∫_{d_β}^{z} φ_β, of `BetaParameters`
phi_beta, phi_beta_slope, psi_beta = phi_alpha, phi_alpha_slope, psi_alpha
