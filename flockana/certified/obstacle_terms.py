"""Repulsion of a sphere at rest in balls and series (Arb).

With a = (x − y)/‖x − y‖ and the clearance c = ‖x − y‖ − R the β-agent is at x − c a and moves at μ (v − ⟨a, v⟩ a),
μ = R/‖x − y‖. The force is analytic in x outside the centre while c stays on one piece of ρ_h: the surface is no switch
(it depends on c² and on c a only), h d_β and d_β are.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from flint import arb

from flockana.base.checks import FloatArray
from flockana.certified.agent_terms import AgentTerm, Block
from flockana.certified.balls import dot, norm, norm2, square
from flockana.certified.series import PairNumbers, Piece


@dataclass(frozen=True)
class SphereTerm(AgentTerm):
    """Force c1β φ_β n̂ + c2β b (p̂ − v) of a sphere at rest."""

    beta: PairNumbers  # The pair law of an agent and its β-agent
    centre: tuple[arb, ...]  # centre, radius: y and R
    radius: arb
    stiffness: arb  # stiffness, damping: c1β and c2β
    damping: arb

    def _away(self, x: Sequence[Any]) -> tuple[list[Any], Any]:
        """Return ((x − y)/‖x − y‖, ‖x − y‖)."""
        away = [a - b for a, b in zip(x, self.centre, strict=True)]
        distance = norm2(away).sqrt()
        return [a / distance for a in away], distance

    def clearance(self, x: Sequence[arb]) -> arb:
        """Return ‖x − y‖ − R, negative inside."""
        return norm([a - b for a, b in zip(x, self.centre, strict=True)]) - self.radius

    def piece(self, x: Sequence[arb]) -> Piece:
        """Return the piece of ρ_h that holds the clearance, anywhere in a box."""
        return self.beta.piece(square(self.clearance(x)))

    def switches(self, x: FloatArray, v: FloatArray) -> list[tuple[float, float]]:
        """Return how far the clearance is beyond h d_β and d_β, and how fast it moves away."""
        away = x - np.array([float(y) for y in self.centre])
        distance = float(np.linalg.norm(away))
        speed = float(away @ v) / distance if distance > 0.0 else float(np.linalg.norm(v))
        return [(distance - float(self.radius) - switch, speed) for switch in self.beta.switches]

    def power(self, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> Any:
        """Return c2β b ⟨v, p̂ − v⟩ = −c2β b ((1 − μ) ‖v − ⟨a, v⟩ a‖² + ⟨a, v⟩²), not positive outside."""
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, dot(a, v)
        across = norm2([w - radial * k for k, w in zip(a, v, strict=True)])
        adjacency = self.beta.pair(square(clearance), piece)[1]
        if isinstance(adjacency, arb):
            adjacency = adjacency.nonnegative_part()  # ρ_h >= 0, whatever its ball says
        return -self.damping * adjacency * (clearance / distance * across + square(radial))

    def force(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> list[Any]:  # noqa: D102
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, dot(a, v)
        weight, adjacency = self.beta.pair(square(clearance), piece)
        push, drag, free = self.stiffness * weight * clearance, self.damping * adjacency, clearance / distance
        return [-push * k - drag * (free * (w - radial * k) + radial * k) for k, w in zip(a, v, strict=True)]

    def slopes(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> tuple[Block, Block]:
        """Return the derivatives of the force by position and velocity, two tables."""
        # With P = I − a aᵀ: ∂a = P/‖x − y‖, ∂c = a, and p̂ turns by −(R/‖x − y‖²)(Pv aᵀ + ⟨a, v⟩ P + a (Pv)ᵀ).
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, dot(a, v)
        s2, mu, free = square(clearance), self.radius / distance, clearance / distance
        (weight, adjacency), (bend, fade) = self.beta.pair(s2, piece), self.beta.slopes(s2, piece)
        stiff, drag = self.stiffness * weight, self.damping * adjacency
        steeper, fading = 2 * self.stiffness * bend * s2, 2 * self.damping * fade * clearance
        across = [w - radial * k for k, w in zip(a, v, strict=True)]
        slip = [-free * w - radial * k for k, w in zip(a, across, strict=True)]
        size = range(len(x))
        by_x, by_v = ([[0] * len(x) for _ in size] for _ in range(2))
        for k, h in product(size, repeat=2):
            along, aside = a[k] * a[h], (1 if k == h else 0) - a[k] * a[h]
            turn = -mu / distance * (across[k] * a[h] + radial * aside + a[k] * across[h])
            by_v[k][h] = -drag * (free * aside + along)
            by_x[k][h] = -stiff * (free * aside + along) - steeper * along + fading * slip[k] * a[h] + drag * turn
        return by_x, by_v
