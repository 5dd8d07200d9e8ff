"""Repulsion of a sphere at rest in balls and series (Arb).

With a = (x − y)/‖x − y‖ and the clearance c = ‖x − y‖ − R the β-agent is at x − c a and moves at μ (v − ⟨a, v⟩ a),
μ = R/‖x − y‖. The force is analytic in x outside the centre while c stays on one piece of ρ_h: the surface is no switch
(it depends on c² and on c a only), h d_β and d_β are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
from flint import arb, arb_series

from flockana.base.checks import FloatArray
from flockana.certified.agent_terms import AgentTerm, Block
from flockana.certified.intervals import (
    BetaParameters,
    bump,
    bump_slope,
    d_beta,
    exact,
    phi_beta,
    phi_beta_slope,
    sigma_of_square,
    square,
)
from flockana.certified.series import Piece


@dataclass(frozen=True)
class BetaNumbers:
    """Numbers of the β-pair law as balls at one precision, lengths in units of ℓ.

    Attributes
    ----------
    par : BetaParameters
        Exact.
    eps, h : arb
        As of the law; ε in units of 1/ℓ².
    cutoff, knee : arb
        d_β and h d_β.
    area : arb
        ℓ².
    """

    par: BetaParameters
    eps: arb
    h: arb
    cutoff: arb
    knee: arb
    area: arb

    @classmethod
    def of(cls, beta: Any) -> BetaNumbers:
        """Return the numbers of a `BetaInteraction` as exact decimals."""
        unit = exact(beta.unit)
        par = BetaParameters(d=exact(beta.d) / unit, eps=exact(beta.eps) * unit * unit, h=exact(beta.h))
        cutoff = d_beta(par)
        return cls(par, arb(par.eps), arb(par.h), cutoff, arb(par.h) * cutoff, arb(unit * unit))

    def piece(self, clearance: arb) -> Piece:
        """Return the piece of ρ_h on which every clearance in a ball lies."""
        z = sigma_of_square(square(clearance) / self.area, self.eps)
        if z > self.cutoff:
            return Piece.OUT
        if z < self.knee:
            return Piece.CORE
        return Piece.TAPER if z > self.knee and z < self.cutoff else Piece.SWITCH

    def weights(self, s2: Any, piece: Piece) -> tuple[Any, Any]:
        """Return (φ_β/√(1 + εs²), b_ik) at a squared clearance: a ball on any pieces, or a series on one."""
        if isinstance(s2, arb):
            z, slant = sigma_of_square(s2 / self.area, self.eps), (1 + self.eps * (s2 / self.area)).rsqrt()
            return phi_beta(z, self.par) * slant, bump(z / self.cutoff, self.par.h)
        z, slant, action, _, rho = self._along(s2, piece)
        return rho * action * slant, rho

    def slopes(self, s2: Any, piece: Piece) -> tuple[Any, Any]:
        """Return the derivatives of `weights` by s², continuous across switches."""
        if isinstance(s2, arb):
            z, slant = sigma_of_square(s2 / self.area, self.eps), (1 + self.eps * (s2 / self.area)).rsqrt()
            along = phi_beta_slope(z, self.par) - self.eps * slant * phi_beta(z, self.par)
            falling = bump_slope(z / self.cutoff, self.par.h) / self.cutoff
        else:
            z, slant, action, action_slope, rho = self._along(s2, piece)
            falling = self._falling(z, piece)
            along = falling * action + rho * action_slope - self.eps * slant * rho * action
        return along * slant * slant / (2 * self.area), falling * slant / (2 * self.area)

    def _along(self, s2: arb_series, piece: Piece) -> tuple[arb_series, ...]:
        """Return (z, 1/√(1 + εs²), σ₁(z − d_β) − 1, its derivative by z, ρ_h) along a path, on one piece."""
        slant = (1 + self.eps * (s2 / self.area)).rsqrt()
        z = ((1 + self.eps * (s2 / self.area)) * slant - 1) / self.eps
        s = z - self.cutoff
        root = (1 + s * s).rsqrt()
        rho = arb_series([1]) if piece is Piece.CORE else (1 + self._phase(z).cos_pi()) / 2
        return z, slant, s * root - 1, root * root * root, rho

    def _falling(self, z: arb_series, piece: Piece) -> arb_series:
        """Return dρ_h/dz on a piece."""
        if piece is Piece.CORE:
            return arb_series([0])
        return -arb.pi() / (2 * (1 - self.h) * self.cutoff) * self._phase(z).sin_pi()

    def _phase(self, z: arb_series) -> arb_series:
        """Return the position on the taper, from 0 to 1."""
        return (z / self.cutoff - self.h) / (1 - self.h)


@dataclass(frozen=True)
class SphereTerm(AgentTerm):
    """Force c1β φ_β n̂ + c2β b (p̂ − v) of a sphere at rest.

    Attributes
    ----------
    beta : BetaNumbers
        The pair law of an agent and its β-agent.
    centre, radius : tuple of arb, arb
        y and R.
    stiffness, damping : arb
        c1β and c2β.
    """

    beta: BetaNumbers
    centre: tuple[arb, ...]
    radius: arb
    stiffness: arb
    damping: arb

    def _away(self, x: Sequence[Any]) -> tuple[list[Any], Any]:
        """Return ((x − y)/‖x − y‖, ‖x − y‖)."""
        away = [a - b for a, b in zip(x, self.centre, strict=True)]
        squares = [square(a) if isinstance(a, arb) else a * a for a in away]
        distance = sum(squares[1:], squares[0]).sqrt()
        return [a / distance for a in away], distance

    def clearance(self, x: Sequence[arb]) -> arb:
        """Return ‖x − y‖ − R, negative inside."""
        squares = sum((square(a - b) for a, b in zip(x, self.centre, strict=True)), arb(0))
        return squares.nonnegative_part().sqrt() - self.radius

    def piece(self, x: Sequence[arb]) -> Piece:
        """Return the piece of ρ_h that holds the clearance, anywhere in a box."""
        return self.beta.piece(self.clearance(x))

    def switches(self, x: FloatArray, v: FloatArray) -> list[tuple[float, float]]:
        """Return how far the clearance is beyond h d_β and d_β, and how fast it moves away."""
        away = x - np.array([float(y) for y in self.centre])
        distance = float(np.linalg.norm(away))
        speed = float(away @ v) / distance if distance > 0.0 else float(np.linalg.norm(v))
        eps, unit, clearance = float(self.beta.eps), sqrt(float(self.beta.area)), distance - float(self.radius)
        meet = [unit * sqrt(((1.0 + eps * float(z)) ** 2 - 1.0) / eps) for z in (self.beta.knee, self.beta.cutoff)]
        return [(clearance - switch, speed) for switch in meet]

    def power(self, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> Any:
        """Return c2β b ⟨v, p̂ − v⟩ = −c2β b ((1 − μ) ‖v − ⟨a, v⟩ a‖² + ⟨a, v⟩²), not positive outside."""
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, _dot(a, v)
        across = sum((_squared(w - radial * k) for k, w in zip(a, v, strict=True)), 0 * radial)
        adjacency = self.beta.weights(_squared(clearance), piece)[1]
        if isinstance(adjacency, arb):
            adjacency = adjacency.nonnegative_part()  # ρ_h >= 0, whatever its ball says
        return -self.damping * adjacency * (clearance / distance * across + _squared(radial))

    def force(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> list[Any]:
        """Return the force at a position and a velocity."""
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, _dot(a, v)
        weight, adjacency = self.beta.weights(_squared(clearance), piece)
        push, drag, free = self.stiffness * weight * clearance, self.damping * adjacency, clearance / distance
        return [-push * k - drag * (free * (w - radial * k) + radial * k) for k, w in zip(a, v, strict=True)]

    def slopes(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> tuple[Block, Block]:
        """Return the derivatives of the force by position and velocity, two tables.

        With P = I − a aᵀ: ∂a = P/‖x − y‖, ∂c = a, and p̂ turns by −(R/‖x − y‖²)(Pv aᵀ + ⟨a, v⟩ P + a (Pv)ᵀ).
        """
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, _dot(a, v)
        s2, mu, free = _squared(clearance), self.radius / distance, clearance / distance
        (weight, adjacency), (bend, fade) = self.beta.weights(s2, piece), self.beta.slopes(s2, piece)
        stiff, drag = self.stiffness * weight, self.damping * adjacency
        steeper, fading = 2 * self.stiffness * bend * s2, 2 * self.damping * fade * clearance
        across = [w - radial * k for k, w in zip(a, v, strict=True)]
        slip = [-free * w - radial * k for k, w in zip(a, across, strict=True)]
        by_x, by_v = [], []
        for k in range(len(x)):
            push, brake = [], []
            for h in range(len(x)):
                aside = (1 if k == h else 0) - a[k] * a[h]
                turn = -mu / distance * (across[k] * a[h] + radial * aside + a[k] * across[h])
                push.append(
                    -stiff * (free * aside + a[k] * a[h])
                    - steeper * a[k] * a[h]
                    + fading * slip[k] * a[h]
                    + drag * turn
                )
                brake.append(-drag * (free * aside + a[k] * a[h]))
            by_x.append(push)
            by_v.append(brake)
        return by_x, by_v


def _squared(x: Any) -> Any:
    """Return x² of a ball, never below 0, or of a series."""
    return square(x) if isinstance(x, arb) else x * x


def _dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    products = [x * y for x, y in zip(a, b, strict=True)]
    return sum(products[1:], products[0])
