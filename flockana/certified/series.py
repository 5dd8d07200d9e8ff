"""Pair laws in balls and along paths as power series in time (Arb), piece by piece.

ρ_h is only C¹ at z = h r_α and at z = r_α. Between these distances, below and beyond, φ_α and a_ij are analytic in the
squared distance, so that the Taylor coefficients of a pair's force follow from those of its path by series arithmetic.
The formulas are generated (`flockana.certified.formulas`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from flint import acb, arb

from flockana.certified import formulas
from flockana.certified.balls import Piece as Piece
from flockana.certified.balls import exact, hull, monotone


@dataclass(frozen=True)
class PairNumbers(ABC):
    """Numbers of a pair law as balls at one precision.

    Attributes
    ----------
    eps, h : arb
        Of the σ-norm and of the bump.
    cutoff : arb
        σ-norm at which the force ends: r_α, or d_β.
    area : arb
        ℓ².
    """

    eps: arb
    h: arb
    cutoff: arb
    area: arb
    name: ClassVar[str]

    @property
    @abstractmethod
    def zero(self) -> arb:
        """The σ-norm at which the potential vanishes."""

    @property
    def knee(self) -> arb:
        """The σ-norm at which the bump begins to fall."""
        return self.h * self.cutoff

    def norm(self, s2: Any) -> Any:
        """Return the σ-norm at a squared distance."""
        return formulas.sigma_norm(s2.nonnegative_part() if isinstance(s2, arb) else s2, self.eps)

    def piece(self, s2: arb) -> Piece:
        """Return the piece on which every squared distance in a ball lies."""
        z = self.norm(s2)
        if z > self.cutoff:
            return Piece.OUT
        if z < self.knee:
            return Piece.CORE
        return Piece.TAPER if z > self.knee and z < self.cutoff else Piece.SWITCH

    def pair(self, s2: Any, piece: Piece = Piece.SWITCH) -> tuple[Any, Any]:
        """Return (weight, adjacency) at a squared distance: a ball on any pieces, or a series on one in range."""
        return self._at("pair", s2, piece)  # type: ignore[no-any-return]

    def slopes(self, s2: Any, piece: Piece = Piece.SWITCH) -> tuple[Any, Any]:
        """Return the derivatives of `pair` by s², which are continuous: a ball holds both sides of a switch."""
        return self._at("slopes", s2, piece)  # type: ignore[no-any-return]

    def _at(self, what: str, s2: Any, piece: Piece) -> Any:
        given = s2.nonnegative_part() if isinstance(s2, arb) else s2
        return getattr(formulas, f"{self.name}_{what}")(given, self, piece)

    def potential(self, s2: arb) -> arb:
        """Return ψ at a squared distance: decreasing to its zero, increasing to the cut-off, constant beyond."""
        return self.potential_of_norm(self.norm(s2))

    def potential_of_norm(self, z: arb) -> arb:
        """Return ψ at a σ-norm."""
        if z <= self.zero or z >= self.zero:
            return monotone(self._potential, z)
        return hull(arb(0), self._potential(z.lower()), self._potential(z.upper()))

    def _potential(self, z: arb) -> arb:
        """Return ψ at a point."""
        return self._far if z >= self.cutoff else self._from_knee(z) - self._from_knee(self.zero)

    @cached_property
    def _far(self) -> arb:
        return self._from_knee(self.cutoff) - self._from_knee(self.zero)

    def _from_knee(self, z: arb) -> arb:
        """Return the integral of the action from the knee: closed form before it, enclosed by Arb after it."""
        closed, tapered = (getattr(formulas, f"{self.name}_{part}") for part in ("closed", "tapered"))
        before = arb(0) if z >= self.knee else closed(z.min(self.knee), self) - closed(self.knee, self)
        if z <= self.knee:
            return before
        end = z.max(self.knee).min(self.cutoff)
        return before + acb.integral(lambda x, analytic: tapered(x, self, analytic), self.knee, end).real


@dataclass(frozen=True)
class AlphaNumbers(PairNumbers):
    """Numbers of the α-pair law; those of φ, and d_α."""

    a: arb
    b: arb
    c: arb
    d_alpha: arb
    name = "alpha"

    @classmethod
    def of(cls, alpha: Any) -> AlphaNumbers:
        """Return the numbers of an interaction, or of exact parameters, where ℓ = 1, as exact decimals."""
        eps, h, a, b, d, r = (arb(exact(getattr(alpha, name))) for name in ("eps", "h", "a", "b", "d", "r"))
        cutoff, zero = (formulas.sigma_norm(x * x, eps) for x in (r, d))
        area = arb(exact(getattr(alpha, "unit", 1))) ** 2
        return cls(eps, h, cutoff, area, a, b, (b - a) / (4 * a * b).sqrt(), zero)

    @property
    def r_alpha(self) -> arb:
        """‖r‖_σ."""
        return self.cutoff

    @property
    def zero(self) -> arb:
        """The σ-norm d_α at which the potential vanishes."""
        return self.d_alpha

    @property
    def far(self) -> arb:
        """ψ_α(r_α), the potential of a pair out of range."""
        return self._far

    @cached_property
    def c_star(self) -> arb:
        """ψ_α(0), the potential of a coincident pair."""
        return self._potential(arb(0))

    def stiffness(self, s2: arb) -> arb:
        """Return F''(ℓ) of F = ψ_α(‖·‖_σ), by s² = ℓ²."""
        return self._at("stiffness", s2, Piece.SWITCH)


@dataclass(frozen=True)
class BetaNumbers(PairNumbers):
    """Numbers of the β-pair law, whose potential vanishes where the force ends."""

    name = "beta"

    @classmethod
    def of(cls, beta: Any) -> BetaNumbers:
        """Return the numbers of a `BetaInteraction` as exact decimals."""
        eps, h, d, unit = (arb(exact(getattr(beta, name))) for name in ("eps", "h", "d", "unit"))
        return cls(eps, h, formulas.sigma_norm(d * d, eps), unit * unit)

    @property
    def d_beta(self) -> arb:
        """‖d'‖_σ."""
        return self.cutoff

    @property
    def zero(self) -> arb:
        """The σ-norm d_β at which the potential vanishes."""
        return self.cutoff
