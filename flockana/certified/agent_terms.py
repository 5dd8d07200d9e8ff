"""Forces on single agents in balls and series (Arb): the pull to a γ-agent on a straight path."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb

from flockana.base.checks import FloatArray
from flockana.certified.balls import dot, norm2
from flockana.certified.series import Piece

Block = list[list[Any]]


class AgentTerm(ABC):
    """Force on each agent that depends on time and on its own state."""

    @abstractmethod
    def force(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> list[Any]:
        """Return the force at a position and a velocity."""

    @abstractmethod
    def slopes(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> tuple[Block, Block]:
        """Return the derivatives of the force by position and velocity, as two tables."""

    @abstractmethod
    def power(self, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> Any:
        """Return the term's part of dH/dt that its own potential does not balance."""

    def piece(self, x: Sequence[arb]) -> Piece:
        """Return the piece of the law that holds a box: `Piece.OUT` for no force, `Piece.CORE` where analytic."""
        return Piece.CORE

    def switches(self, x: FloatArray, v: FloatArray) -> list[tuple[float, float]]:
        """Return how far the state is beyond each switch, and how fast it leaves; floating-point proposals."""
        return []

    def drift(self, t: arb, x: Sequence[arb]) -> list[arb]:
        """Return the derivative of the force by time at a fixed state."""
        return [arb(0)] * len(x)


@dataclass(frozen=True)
class Pull(AgentTerm):
    """Pull −c1γ (x − q_r) − c2γ (v − p_r), or with the first term bounded, −c1γ (x − q_r)/√(1 + ‖x − q_r‖²/ℓ²)."""

    start: tuple[arb, ...]  # start, velocity, declared: q_r = start + velocity t, and p_r
    velocity: tuple[arb, ...]
    declared: tuple[arb, ...]
    stiffness: arb  # stiffness, damping: c1γ and c2γ
    damping: arb
    unit: arb | None = None  # ℓ; None for the linear pull

    def _away(self, t: Any, x: Sequence[Any]) -> list[Any]:
        """Return x − q_r."""
        return [a - (b + c * t) for a, b, c in zip(x, self.start, self.velocity, strict=True)]

    def _saturation(self, away: Sequence[Any], unit: arb) -> Any:
        """Return 1/√(1 + ‖x − q_r‖²/ℓ²)."""
        return (1 + norm2(away) / (unit * unit)).rsqrt()

    def force(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> list[Any]:  # noqa: D102
        away = self._away(t, x)
        if self.unit is not None:
            slant = self._saturation(away, self.unit)
            away = [a * slant for a in away]
        rows = zip(away, v, self.declared, strict=True)
        return [-self.stiffness * a - self.damping * (w - p) for a, w, p in rows]

    def slopes(self, t: Any, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> tuple[Block, Block]:  # noqa: D102
        rows = list(enumerate(away := self._away(t, x)))
        pull, drag = ([[-gain * (k == h) for h, _ in rows] for k, _ in rows] for gain in (self.stiffness, self.damping))
        if self.unit is not None:
            slant = self._saturation(away, self.unit)
            cube = slant * slant * slant / (self.unit * self.unit)
            pull = [[-self.stiffness * ((slant if k == h else 0) - cube * a * b) for h, b in rows] for k, a in rows]
        return pull, drag

    def power(self, x: Sequence[Any], v: Sequence[Any], piece: Piece) -> Any:
        """Return −c2γ ⟨v, v − p_r⟩, for a γ-agent at rest."""
        return -self.damping * (norm2(v) - dot(v, self.declared))

    def drift(self, t: arb, x: Sequence[arb]) -> list[arb]:
        """Return the derivative of the force by time, from the motion of q_r."""
        pull = self.slopes(t, x, x, Piece.CORE)[0]
        return [-dot(row, self.velocity) for row in pull]
