"""Pair laws in balls and along paths as power series in time (Arb), piece by piece.

ρ_h is only C¹ at z = h r_α and at z = r_α. Between these distances, below and beyond, φ_α and a_ij are analytic in the
squared distance, so that the Taylor coefficients of a pair's force follow from those of its path by series arithmetic.
The formulas are generated (`flockana.certified.formula_in_balls`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import Any

from flint import arb, fmpq

from flockana.certified import formula_in_balls
from flockana.certified.balls import Piece as Piece
from flockana.certified.balls import exact, hull, integrate, monotone


@dataclass(frozen=True)
class PairNumbers:
    """Constants of a pair law (σ-norm, bump function, action φ) as balls at one precision.

    The β-pair's action is the α-pair's with φ(s) = σ₁(s) − 1, which is φ of a = 0, b = 2 and c = 0.
    """

    eps: arb  # eps, h: Of the σ-norm and of the bump
    h: arb
    a: arb  # a, b, c: Of φ
    b: arb
    c: arb
    zero: arb  # σ-norm at which the potential vanishes: d_α, or d_β
    cutoff: arb  # σ-norm at which the force ends: r_α, or d_β
    area: arb  # ℓ²

    @classmethod
    def of_alpha(cls, alpha: Any, number: Callable[[Any], fmpq] = exact) -> PairNumbers:
        """Return the constants of an `AlphaInteraction`, or of exact parameters, as balls."""
        eps, h, a, b, d, r = (arb(number(getattr(alpha, name))) for name in ("eps", "h", "a", "b", "d", "r"))
        zero, cutoff = (formula_in_balls.sigma_norm(x * x, eps) for x in (d, r))
        return cls(
            eps, h, a, b, (b - a) / (4 * a * b).sqrt(), zero, cutoff, arb(number(getattr(alpha, "unit", 1))) ** 2
        )

    @classmethod
    def of_beta(cls, beta: Any, number: Callable[[Any], fmpq] = exact) -> PairNumbers:
        """Return the constants of a `BetaInteraction` as balls."""
        eps, h, d, unit = (arb(number(getattr(beta, name))) for name in ("eps", "h", "d", "unit"))
        cutoff = formula_in_balls.sigma_norm(d * d, eps)
        return cls(eps, h, arb(0), arb(2), arb(0), cutoff, cutoff, unit**2)

    @property
    def knee(self) -> arb:
        """The σ-norm at which the bump begins to fall."""
        return self.h * self.cutoff

    @property
    def switches(self) -> list[float]:
        """Distances at which the pair law passes from one smooth piece to the next, in floating point."""
        eps = float(self.eps)
        return [sqrt(((1.0 + eps * float(z)) ** 2 - 1.0) / eps) for z in (self.knee, self.cutoff)]

    def piece(self, s2: arb) -> Piece:
        """Return the smooth piece of the pair law that holds for all squared distances in a ball."""
        z = formula_in_balls.sigma_norm(s2.nonnegative_part(), self.eps)
        if z > self.cutoff:
            return Piece.OUT
        if z < self.knee:
            return Piece.CORE
        return Piece.TAPER if z > self.knee and z < self.cutoff else Piece.SWITCH

    def pair(self, s2: Any, piece: Piece = Piece.SWITCH) -> tuple[Any, Any]:
        """Return a pair's weight of q_j − q_i in the force and its adjacency a_ij, at a squared distance."""
        return formula_in_balls.pair(_nonnegative(s2), self, piece)

    def slopes(self, s2: Any, piece: Piece = Piece.SWITCH) -> tuple[Any, Any]:
        """Return the derivatives of a pair's force weight and adjacency by the squared distance."""
        return formula_in_balls.slopes(_nonnegative(s2), self, piece)

    def stiffness(self, s2: arb) -> arb:
        """Return the stiffness F''(ℓ) of the pair potential F = ψ(‖·‖_σ), by s² = ℓ²."""
        return formula_in_balls.stiffness(_nonnegative(s2), self, Piece.SWITCH)

    def potential(self, s2: arb) -> arb:
        """Return the pair potential ψ at a squared distance; it is constant beyond the cutoff."""
        z = formula_in_balls.sigma_norm(s2.nonnegative_part(), self.eps)
        if z <= self.zero or z >= self.zero:
            return monotone(self._potential, z)
        return hull(arb(0), self._potential(z.lower()), self._potential(z.upper()))

    @cached_property
    def far(self) -> arb:
        """Potential of a pair out of range: ψ_α(r_α), or 0."""
        return self._from_knee(self.cutoff) - self._from_knee(self.zero)

    @cached_property
    def c_star(self) -> arb:
        """Potential ψ(0) of a coincident pair."""
        return self._potential(arb(0))

    def _potential(self, z: arb) -> arb:
        """Return the pair potential ψ at one σ-norm of the distance."""
        return self.far if z >= self.cutoff else self._from_knee(z) - self._from_knee(self.zero)

    def _from_knee(self, z: arb) -> arb:
        """Return the integral of the pair action from the σ-norm at which the bump begins to fall."""
        knee = self.knee
        inner_part = (
            arb(0) if z >= knee else formula_in_balls.closed(z.min(knee), self) - formula_in_balls.closed(knee, self)
        )
        if z <= knee:
            return inner_part
        end = z.max(knee).min(self.cutoff)
        return inner_part + integrate(lambda x, analytic: formula_in_balls.tapered(x, self, analytic), knee, end)


def _nonnegative(s2: Any) -> Any:
    return s2.nonnegative_part() if isinstance(s2, arb) else s2
