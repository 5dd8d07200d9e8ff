"""Alignment with each agent's own sums: the velocity diameter contracts as the influence at the position diameter."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _contraction() -> Iterator[Step]:
    a, b, x = (z3.Reals(" ".join(f"{letter}{j}" for j in range(3))) for letter in "abx")
    common = z3.Real("c")
    least = [z3.If(one < other, one, other) for one, other in zip(a, b, strict=True)]
    rows = [each >= 0 for each in (*a, *b)] + [sum(row) == 1 for row in (a, b)]
    yield implication(
        "two rows of weights that sum to 1 and have c = Σ_j min(a_j, b_j) in common: of numbers x_j in [0, 1] their "
        "means differ by at most 1 - c (checked: three agents; the rests a_j - min and b_j - min sum to 1 - c each)",
        sum(u * y for u, y in zip(a, x, strict=True)) - sum(u * y for u, y in zip(b, x, strict=True)) <= 1 - common,
        *(*rows, *(z3.And(each >= 0, each <= 1) for each in x), common == sum(least)),
    )
    gain, diameter = z3.Reals("alpha D")
    yield implication(
        "so for the pair whose velocities differ most, p_i' - p_k' = α (Σ a_j p_j - Σ b_j p_j - (p_i - p_k)) along it: "
        "d_V' <= α ((1 - c) d_V - d_V) = -αc d_V",
        gain * ((1 - common) * diameter - diameter) == -gain * common * diameter,
        *(gain > 0, diameter >= 0, common >= 0),
        latex=r"\dot d_V \le -\alpha c\,d_V",
    )


def _common_part() -> Iterator[Step]:
    phi, total, n, at = z3.Reals("phi S n f")
    yield implication(
        "influences lie between f = φ(d_X) and φ(0) = 1, a sum of n of them is at most n: each weight φ/S >= f/n, and "
        "the n terms of c add up to at least f",
        n * (phi / total) >= at,
        *(n >= 1, at > 0, phi >= at, phi <= 1, total > 0, total <= n),
        latex=r"c \ge \varphi(d_X)",
    )
    speed, fall = z3.Reals("d_V f2")
    yield implication(
        "d_X' <= d_V, so d_V + α∫φ up to d_X does not rise: where ∫φ beyond d_X(0) is larger than d_V(0)/α, d_X stays "
        "below x_M, and d_V falls at the rate αφ(x_M)",
        -at * speed + at * phi <= 0,
        *(at > 0, speed >= 0, phi <= speed),
    )
    yield implication(
        "φ² <= φ, as φ <= 1: the integral of φ² is a stronger condition", fall <= at, at > 0, at <= 1, fall == at * at
    )


def _pair() -> Iterator[Step]:
    s = sp.Symbol("s", positive=True)
    phi, root = 1 / (1 + s**2), sp.sqrt(2)
    yield Step(
        "two agents hear each other with φ/(1 + φ): their relative velocity falls at 2αφ/(1 + φ), of which the "
        "integral beyond 1 is √2 (π/2 - atan(1/√2)) for φ = 1/(1 + s²), against π/4 of φ and (π - 2)/8 of φ²",
        all(
            sp.simplify(known.diff(s) - f) == 0
            and sp.simplify(sp.limit(known, s, sp.oo) - known.subs(s, 1) - value) == 0
            for f, known, value in (
                (2 * phi / (1 + phi), root * sp.atan(s / root), root * (sp.pi / 2 - sp.atan(1 / root))),
                (phi, sp.atan(s), sp.pi / 4),
                (phi**2, s / (2 * (1 + s**2)) + sp.atan(s) / 2, (sp.pi - 2) / 8),
            )
        ),
        r"\int_1^\infty \tfrac{2\varphi}{1+\varphi}\,ds = \sqrt2\,(\tfrac\pi2 - \arctan\tfrac1{\sqrt2})",
    )


def _steps() -> Iterator[Step]:
    yield from _contraction()
    yield from _common_part()
    yield from _pair()


PROOF = Proof(
    id="own-sums",
    title="Alignment with each agent's own sums",
    statement=(
        "Under u_i = α Σ_j φ_ij (p_j - p_i)/Σ_k φ_ik, φ falling from φ(0) = 1, the largest difference of velocities "
        "falls at αφ(d_X) at least; if it is below α∫φ from d_X(0) on, all positions stay within x_M and velocities "
        "match exponentially."
    ),
    hypotheses="α > 0; 0 < φ <= 1, falling; the sum over k includes i. A diameter has one-sided slopes (cited)",
    rigour="smt",
    theorems=("motsch-tadmor", "motsch-tadmor-sharp"),
    steps=_steps,
    size=6,
)
