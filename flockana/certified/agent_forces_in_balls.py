"""Forces on single agents in balls and series (Arb): the pull to a γ-agent on a straight path, and spheres at rest.

With a = (x − y)/‖x − y‖ and the clearance c = ‖x − y‖ − R of a sphere, the β-agent is at x − c a and moves at
μ (v − ⟨a, v⟩ a), μ = R/‖x − y‖. The force is analytic in x outside the centre while c stays on one piece of ρ_h: the
surface is no switch (it depends on c² and on c a only), h d_β and d_β are.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from flint import arb

from flockana.base.value_checks import FloatArray
from flockana.certified.balls import dot, minus, norm, norm2, square
from flockana.certified.pair_laws_in_series import PairNumbers, Piece

Block = list[list[Any]]


@dataclass(frozen=True)
class Pull:
    """Pull −c1γ (x − q_r) − c2γ (v − p_r) of a γ-agent; if bounded, its first term over √(1 + ‖x − q_r‖²/ℓ²)."""

    start: tuple[arb, ...]  # start, velocity, declared: q_r = start + velocity t, and p_r
    velocity: tuple[arb, ...]
    declared: tuple[arb, ...]
    stiffness: arb  # stiffness, damping: c1γ and c2γ
    damping: arb
    unit: arb | None = None  # ℓ; None for the linear pull

    def _away(self, t: Any, x: Sequence[Any]) -> list[Any]:
        """Return x − q_r, the vector from the γ-agent to the agent."""
        return [a - (b + c * t) for a, b, c in zip(x, self.start, self.velocity, strict=True)]

    def _saturation(self, away: Sequence[Any], unit: arb) -> Any:
        """Return 1/√(1 + ‖x − q_r‖²/ℓ²), the factor that bounds the pull."""
        return (1 + norm2(away) / (unit * unit)).rsqrt()

    def piece(self, x: Sequence[arb]) -> Piece:
        """Return the smooth piece of the γ-agent's pull at a position: `Piece.CORE`, as it is one formula."""
        return Piece.CORE

    def switches(self, x: FloatArray, v: FloatArray) -> list[tuple[float, float]]:
        """Return the switching distances of the γ-agent's pull: none, as it is analytic everywhere."""
        return []

    def force(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> list[Any]:
        """Return the force that a γ-agent exerts on an agent of given position and velocity."""
        displacement = self._away(t, x)
        if self.unit is not None:
            saturation_factor = self._saturation(displacement, self.unit)
            displacement = [a * saturation_factor for a in displacement]
        rows = zip(displacement, v, self.declared, strict=True)
        return [-self.stiffness * a - self.damping * (w - p) for a, w, p in rows]

    def slopes(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> tuple[Block, Block]:
        """Return the Jacobians of a γ-agent's pull by the agent's position and velocity, as two matrices."""
        rows = list(enumerate(displacement := self._away(t, x)))
        pull, drag = ([[-gain * (k == h) for h, _ in rows] for k, _ in rows] for gain in (self.stiffness, self.damping))
        if self.unit is not None:
            slant = self._saturation(displacement, self.unit)
            cube = slant * slant * slant / (self.unit * self.unit)
            pull = [[-self.stiffness * ((slant if k == h else 0) - cube * a * b) for h, b in rows] for k, a in rows]
        return pull, drag

    def power(self, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> Any:
        """Return the part of dH/dt not balanced by the pull's potential: −c2γ ⟨v, v − p_r⟩, for a γ-agent at rest."""
        return -self.damping * (norm2(v) - dot(v, self.declared))

    def drift(self, t: arb, x: Sequence[arb]) -> list[arb]:
        """Return the partial derivative by time of the γ-agent's pull, from the motion of q_r."""
        pull = self.slopes(t, x, x, Piece.CORE)[0]
        return [-dot(row, self.velocity) for row in pull]


@dataclass(frozen=True)
class SphereTerm:
    """Force c1β φ_β n̂ + c2β b (p̂ − v) of a sphere at rest."""

    beta: PairNumbers  # The pair law of an agent and its β-agent
    centre: tuple[arb, ...]  # centre, radius: y and R
    radius: arb
    stiffness: arb  # stiffness, damping: c1β and c2β
    damping: arb

    def _away(self, x: Sequence[Any]) -> tuple[list[Any], Any]:
        """Return the unit vector (x − y)/‖x − y‖ from the sphere's centre, and the distance ‖x − y‖."""
        displacement = minus(x, self.centre)
        distance = norm2(displacement).sqrt()
        return [a / distance for a in displacement], distance

    def clearance(self, x: Sequence[arb]) -> arb:
        """Return the clearance ‖x − y‖ − R from the sphere, negative inside."""
        return norm(minus(x, self.centre)) - self.radius

    def piece(self, x: Sequence[arb]) -> Piece:
        """Return the smooth piece of the bump function ρ_h for the clearances of all points of a box."""
        return self.beta.piece(square(self.clearance(x)))

    def switches(self, x: FloatArray, v: FloatArray) -> list[tuple[float, float]]:
        """Return how far an agent's clearance is from each switch h d_β, d_β of the force, and the rates."""
        displacement = x - np.array([float(y) for y in self.centre])
        distance = float(np.linalg.norm(displacement))
        speed = float(displacement @ v) / distance if distance > 0.0 else float(np.linalg.norm(v))
        return [(distance - float(self.radius) - switch, speed) for switch in self.beta.switches]

    def power(self, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> Any:
        """Return the power c2β b ⟨v, p̂ − v⟩ of the obstacle's damping force on an agent."""
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, dot(a, v)
        transverse_square = norm2([w - radial * k for k, w in zip(a, v, strict=True)])
        adjacency = self.beta.pair(square(clearance), piece)[1]
        if isinstance(adjacency, arb):
            adjacency = adjacency.nonnegative_part()  # ρ_h >= 0, whatever its ball says
        return -self.damping * adjacency * (clearance / distance * transverse_square + square(radial))

    def drift(self, t: arb, x: Sequence[arb]) -> list[arb]:
        """Return the time derivative of the sphere's force: 0, as the sphere is at rest."""
        return [arb(0)] * len(x)

    def force(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> list[Any]:
        """Return the force of a spherical obstacle on an agent of given position and velocity."""
        a, distance = self._away(x)
        clearance, radial = distance - self.radius, dot(a, v)
        weight, adjacency = self.beta.pair(square(clearance), piece)
        push, drag, free_share = self.stiffness * weight * clearance, self.damping * adjacency, clearance / distance
        return [-push * k - drag * (free_share * (w - radial * k) + radial * k) for k, w in zip(a, v, strict=True)]

    def slopes(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> tuple[Block, Block]:
        """Return the Jacobians of a spherical obstacle's force by the agent's position and velocity."""
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


AgentTerm = Pull | SphereTerm
