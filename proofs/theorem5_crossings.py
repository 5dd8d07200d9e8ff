"""Theorem 5(i): links of an α-lattice do not cross; nor do those of any net whose pairs are farther apart than r/√2.

Two links that share a point X without sharing an agent are AC and BD with A = X - s w, C = X + (1 - s) w and
B = X - t z, D = X + (1 - t) z, 0 <= s, t <= 1, where w and z may be any vectors: parallel ones make the links
collinear, s = 0 puts an agent on the other link, w = 0 makes two agents coincide. So no case is left to a picture.
Links AB and AC that share the agent A cross if B and C lie on one ray from A.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication

HALF = z3.Q(1, 2)


def weighted_mean(m: int) -> sp.Expr:
    """Left minus right side: the mean of the four squared sides, weighted by how X divides the links."""
    s, t = sp.symbols("s t")
    w, z = (sp.Matrix(sp.symbols(f"{name}_1:{m + 1}")) for name in "wz")
    first = ((1 - s, -s * w), (s, (1 - s) * w))  # weight and position of A and C, with X at the origin
    second = ((1 - t, -t * z), (t, (1 - t) * z))
    mean = sum(f * g * (p - q).dot(p - q) for f, p in first for g, q in second)
    return sp.expand(mean - s * (1 - s) * w.dot(w) - t * (1 - t) * z.dot(z))


def squared_sides(a: Any, b: Any, c: Any, e: Any, k: Any) -> tuple[Any, Any, Any, Any]:
    """Squares of AB, BC, CD, DA where AX = a, XC = b, BX = c, XD = e and k is the cosine; of sympy or of z3."""
    return (
        a**2 + c**2 - 2 * a * c * k,
        b**2 + c**2 + 2 * b * c * k,
        b**2 + e**2 - 2 * b * e * k,
        a**2 + e**2 + 2 * a * e * k,
    )


def cosine_mean() -> tuple[sp.Expr, sp.Expr]:
    """Left minus right side of the mean by the law of cosines, ab + ce, and of the sum of its weights."""
    a, b, c, e, k = sp.symbols("a b c e k")
    weights = (b * e, a * e, a * c, b * c)
    total = sum(f * side for f, side in zip(weights, squared_sides(a, b, c, e, k), strict=True))
    whole = (a + b) * (c + e)
    return sp.expand(total - (a * b + c * e) * whole), sp.expand(sum(weights) - whole)


def short_side(text: str, square: Any, *given: Any) -> Step:
    """The step that of crossing links of lengths at most 1 some side is at most the root of `square`."""
    a, b, c, e, k = z3.Reals("a b c e k")
    crossing = (a >= 0, b >= 0, c >= 0, e >= 0, a + b <= 1, c + e <= 1, k >= -1, k <= 1)
    return implication(text, z3.Or(*(side <= square for side in squared_sides(a, b, c, e, k))), *crossing, *given)


def _in_every_dimension() -> Iterator[Step]:
    for m in (1, 2, 3):
        yield Step(
            f"m = {m}: the squared sides have the weighted mean s(1 - s)|w|² + t(1 - t)|z|²",
            weighted_mean(m) == 0,
            r"(1{-}s)(1{-}t)|AB|^2 + s(1{-}t)|BC|^2 + st|CD|^2 + (1{-}s)t|DA|^2 = s(1{-}s)|w|^2 + t(1{-}t)|z|^2",
            "the difference, expanded in coordinates about X, is 0",
        )
    s, t, w, z, longest, mean = z3.Reals("s t |w|² |z|² ℓ² mean")
    inside = (s >= 0, s <= 1, t >= 0, t <= 1)
    yield implication(
        "that mean is at most ℓ²/2 if neither link is longer than ℓ",
        s * (1 - s) * w + t * (1 - t) * z <= longest / 2,
        *(*inside, w >= 0, z >= 0, w <= longest, z <= longest),
        latex=r"s(1-s)|w|^2 + t(1-t)|z|^2 \le \tfrac14 |w|^2 + \tfrac14 |z|^2 \le \tfrac12 \ell^2",
    )
    sides = z3.Reals("AB² BC² CD² DA²")
    weights = ((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t)
    yield implication(
        "some side is no longer than the mean, whose weights are nonnegative and add up to 1: it is at most ℓ/√2",
        z3.Or(*(side <= mean for side in sides)),
        *(*inside, mean == z3.Sum(*(f * side for f, side in zip(weights, sides, strict=True)))),
    )


def _in_the_plane() -> Iterator[Step]:
    for m in (1, 2, 3):
        w, z = (sp.Matrix(sp.symbols(f"{name}_1:{m + 1}")) for name in "wz")
        minors = sum((w[i] * z[j] - w[j] * z[i]) ** 2 for i in range(m) for j in range(i))
        yield Step(
            f"again, by the law of cosines, m = {m}: the cosine k of two links has |k| <= 1 (Lagrange's identity)",
            sp.expand(w.dot(w) * z.dot(z) - w.dot(z) ** 2 - minors) == 0,
            r"|w|^2|z|^2 - \langle w, z\rangle^2 = \sum_{i<j} (w_i z_j - w_j z_i)^2 \ge 0",
        )
    a, c, k = sp.symbols("a c k", real=True)
    plane = a * sp.Matrix([1, 0]) - c * sp.Matrix([k, sp.sqrt(1 - k**2)])
    yield Step(
        "links that meet in space lie in one plane: directions (1, 0) and (k, √(1 - k²)) give the same distances",
        sp.expand(plane.dot(plane) - squared_sides(a, 0, c, 0, k)[0]) == 0,
    )
    residual, weights = cosine_mean()
    yield Step(
        "the weighted mean of the squared sides is ab + ce",
        residual == 0 and weights == 0,
        r"\frac{be\,|AB|^2 + ae\,|BC|^2 + ac\,|CD|^2 + bc\,|DA|^2}{(a+b)(c+e)} = ab + ce \le \frac{\ell^2}{2}",
    )
    angle = z3.Real("k")
    yield short_side("if links of lengths at most 1 cross, some side is at most 1/√2", HALF)
    yield short_side("collinear links included", HALF, z3.Or(angle == 1, angle == -1))
    yield short_side("an agent on the other link included", HALF, z3.Real("a") == 0)


def _common_agent() -> Step:
    x, y, length = z3.Reals("|AB| |AC| ℓ")
    return implication(
        "links AB, AC with B and C on one ray from A, AB the shorter: AB or BC is at most ℓ/2, less than ℓ/√2",
        z3.Or(2 * x <= length, 2 * (y - x) <= length),
        *(x > 0, y >= x, length >= y),
    )


def _lattices() -> Iterator[Step]:
    side, d, r = z3.Reals("side d r")
    lattice = (d > 0, r > d, side >= 0, z3.Implies(side < r, side == d))
    yield implication(
        "α-lattice, no common agent: no pair is within d/√2, as it would be a link shorter than d",
        2 * side**2 > d**2,
        *lattice,
        latex=r"\|q_j - q_i\| < r \implies \|q_j - q_i\| = d",
    )
    yield implication(
        "α-lattice, common agent: both links being d long, B and C on one ray from A coincide, which no pair does",
        side > 0,
        *lattice,
    )


def every_net(square: Any) -> Iterator[Step]:
    """No two links cross if all pairs are farther apart than the root of `square` times r, or times the longest."""
    side, length, least = z3.Reals("side ℓ r")
    far = (length > 0, length <= least, side >= 0, side**2 > square * least**2)
    yield implication(
        "every net, no common agent: if all pairs are farther apart than r/√2, none is within ℓ/√2; r or the "
        "longest link, of which no link is longer",
        2 * side**2 > length**2,
        *far,
        latex=r"\ell \le r,\ \|q_j - q_i\| > \tfrac{r}{\sqrt2} \implies \|q_j - q_i\| > \tfrac{\ell}{\sqrt2}",
    )
    yield implication("every net, common agent: nor is any within ℓ/2", 2 * side > length, *far)


def _sharp() -> Iterator[Step]:
    half = sp.Rational(1, 2)
    yield Step(
        "a square with diagonals d has all sides d/√2: the constant is the best",
        squared_sides(half, half, half, half, 0) == (half,) * 4,
    )
    kappa, side = z3.Reals("κ² side²")
    yield implication(
        "for every κ < 1/√2 some square has sides longer than κr, and diagonals shorter than r that cross",
        z3.And(side > kappa, 2 * side < 1),
        *(kappa > 0, kappa < HALF, side == (kappa + HALF) / 2),
        latex=r"\text{side}^2 = \tfrac12\left(\kappa^2 + \tfrac12\right) r^2",
    )


def _steps() -> Iterator[Step]:
    yield from _in_every_dimension()
    yield from _in_the_plane()
    yield _common_agent()
    yield from _lattices()
    yield from every_net(HALF)
    yield from _sharp()


PROOF = Proof(
    id="theorem5-crossings",
    title="Theorem 5(i) and its extension: which links do not cross",
    statement=(
        "If two links of lengths at most ℓ cross, some two of their agents are within ℓ/√2 of each other. Hence no two "
        "links of an α-lattice cross, and no two links of any net whose pairs are all farther apart than r/√2, or than "
        "ℓ/√2 with ℓ its longest link; m = 1, 2, 3. No smaller constant will do."
    ),
    hypotheses=(
        "links are the pairs closer than r; links cross if they share a point other than the position of a common "
        "agent; for an α-lattice, all links have length d < r and positions are distinct"
    ),
    rigour="smt",
    theorems=("os-5", "os-5-terminal"),
    steps=_steps,
    size=20,
)
