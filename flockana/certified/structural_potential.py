"""Structural potential U(x) = c1α V(x) + ½ c1γ ‖x‖² of Algorithms 1 and 2 in balls.

In the frame of the centre of mass both laws read x' = v, v' = −∇U(x) − (c2γ + c2α L̂(x)) v on Σ x_i = 0, with
c1γ = c2γ = 0 under Algorithm 1. A configuration is a list of balls x_11, ..., x_1m, x_21, ...
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import combinations, product
from typing import Any

from flint import arb, arb_mat, ctx, fmpq

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import rescale
from flockana.certified.balls import AlphaParameters, ball, exact, norm2, square
from flockana.certified.pair_laws_in_series import PairNumbers
from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, ensure_one_gain

Balls = Sequence[arb]


def in_lengths_of_unit(law: Any) -> Any:
    """Return a law with ℓ, the unit of σ₁, as its unit of length; unchanged where ℓ = 1."""
    unit = getattr(law.alpha, "unit", 1.0)
    if unit == 1.0:
        return law
    law = rescale(law, length=1.0 / unit)
    return replace(law, alpha=replace(law.alpha, unit=1.0))  # but for rounding it is


@dataclass(frozen=True)
class Structure:
    """Exact gains and parameters of the structural potential U and of the damping, for n agents in m dimensions."""

    par: AlphaParameters
    c1_alpha: fmpq
    c2_alpha: fmpq
    c1_gamma: fmpq
    c2_gamma: fmpq
    n: int
    m: int

    @classmethod
    def of(cls, law: Any, n: int, m: int) -> Structure:
        """Return the exact structure of a law; raise unless the law is Algorithm 1 or 2."""
        if type(law) not in (Algorithm1, Algorithm2) or not isinstance(law.alpha, AlphaInteraction):
            raise ArgumentError(
                f"law = {format_value(law)}: expected Algorithm1 or Algorithm2 with AlphaInteraction, unwrapped"
            )
        if law.alpha.unit != 1.0:
            raise ArgumentError(f"unit = {law.alpha.unit:g}: expected 1; rescale law and places by it (fl.rescale)")
        has_target, gains = isinstance(law, Algorithm2), law.gains
        if has_target:
            ensure_one_gain(gains)
        if not (c1 := gains.c1_alpha) > 0.0:
            raise ArgumentError(f"c1_alpha = {c1:g}: expected more than 0, or no force holds the agents together")
        pull = (exact(gains.c1_gamma), exact(gains.c2_gamma)) if has_target else (exact(0), exact(0))
        return cls(AlphaParameters.of(law.alpha), exact(c1), exact(gains.c2_alpha), *pull, n, m)

    def pairs(self, x: Balls) -> Iterator[tuple[int, int, list[arb], arb]]:
        """Return (i, j, x_j − x_i, squared distance) of every pair."""
        m = self.m
        for i, j in combinations(range(self.n), 2):
            gap = [x[m * j + a] - x[m * i + a] for a in range(m)]
            yield i, j, gap, norm2(gap)

    def near(self, x: Balls) -> Iterator[tuple[int, int, list[arb], arb]]:
        """Return (i, j, x_j − x_i, squared distance) of every pair that may be in range."""
        squared_range = ball(self.par.r) ** 2
        return (pair for pair in self.pairs(x) if not pair[3] >= squared_range)

    def tension(self, s: arb) -> arb:
        """Return the tension F'(ℓ)/ℓ of a pair with the potential F = c1α ψ_α(‖·‖_σ), by s = ℓ²."""
        return ball(self.c1_alpha) * self._law.pair(s)[0]

    def stiffness(self, s: arb) -> arb:
        """Return the stiffness F''(ℓ) of a pair, by s = ℓ²."""
        return ball(self.c1_alpha) * self._law.stiffness(s)

    def weight(self, s: arb) -> arb:
        """Return the adjacency a_ij of a pair, by s = ℓ²."""
        return self._law.pair(s)[1]

    def gradient(self, x: Balls) -> list[arb]:
        """Return the gradient ∇U of the structural potential."""
        m, total = self.m, [ball(self.c1_gamma) * y for y in x]
        for i, j, gap, s in self.near(x):
            pull = self.tension(s)
            for a in range(m):
                total[m * j + a] += pull * gap[a]
                total[m * i + a] -= pull * gap[a]
        return total

    def hessian(self, x: Balls) -> arb_mat:
        """Return the Hessian ∇²U: of each pair the block T 1 + (F'' − T) uuᵀ, and c1γ."""
        near_pairs = ((i, j, gap, s, self.tension(s)) for i, j, gap, s in self.near(x))
        return self.assembled([(i, j, outer(gap, t, (self.stiffness(s) - t) / s)) for i, j, gap, s, t in near_pairs])

    def assembled(self, blocks: Sequence[tuple[int, int, list[list[arb]]]]) -> arb_mat:
        """Return the matrix of c1γ‖w‖² + Σ ⟨δ, B δ⟩, δ = w_j − w_i, over pairs with their blocks B."""
        m, size, gain = self.m, self.n * self.m, ball(self.c1_gamma)
        total = [[gain if i == j else arb(0) for j in range(size)] for i in range(size)]
        for i, j, block in blocks:
            for a, b in product(range(m), repeat=2):
                for p, q, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                    total[m * p + a][m * q + b] += sign * block[a][b]
        return arb_mat(total)

    def energy(self, x: Balls) -> arb:
        """Return the structural potential U."""
        law, squared_range = self._law, ball(self.par.r) ** 2
        total = sum((law.far if s >= squared_range else law.potential(s) for *_, s in self.pairs(x)), arb(0))
        return ball(self.c1_alpha) * total + ball(self.c1_gamma) / 2 * norm2(x)

    def rotation_tangents(self, x: Balls) -> list[list[arb]]:
        """Return a basis of tangents Ωx of the orbit of x under rotations: 0, 1 or 3 vectors."""
        m, indices = self.m, range(len(x))
        return [
            [x[k - b + a] if k % m == b else -x[k - a + b] if k % m == a else arb(0) for k in indices]
            for a, b in combinations(range(m), 2)
        ]

    def translations(self) -> list[list[arb]]:
        """Return the displacement vectors of all agents by one unit along each axis."""
        return [[arb(int(k % self.m == a)) for k in range(self.n * self.m)] for a in range(self.m)]

    @property
    def _law(self) -> PairNumbers:
        """Return the α-pair law as balls of the current precision."""
        return _numbers(self.par, ctx.prec)


@cache
def _numbers(par: AlphaParameters, bits: int) -> PairNumbers:
    return PairNumbers.of_alpha(par)


def outer(gap: Sequence[arb], across: arb, more: arb) -> list[list[arb]]:
    """Return the m × m matrix across·1 + more·gap gapᵀ of a pair with relative position gap."""
    return [
        [more * (square(x) if a == b else x * y) + (across if a == b else arb(0)) for b, y in enumerate(gap)]
        for a, x in enumerate(gap)
    ]
