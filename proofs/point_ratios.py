"""How many points can have all distances within a factor of each other: fewer than some number, by dimension.

m + 2 points of m dimensions fall into two parts whose hulls meet (Radon). Where they meet, two weighted means agree,
and then the mean squared distance between the parts is the sum of the variances within them.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import combinations, count

import sympy as sp
from flint import arb

from flockana.certified.balls import ball
from proofs.proof import Step

DIMENSIONS = (1, 2, 3)


def parts(m: int) -> list[tuple[int, int]]:
    """Sizes of two disjoint parts, neither empty, of at most m + 2 points."""
    return [(a, b) for a in range(1, m + 2) for b in range(a, m + 2) if a + b <= m + 2]


def least_square(m: int) -> Fraction:
    """Longest over shortest squared distance of m + 2 points, at least: 2/(2 - 1/a - 1/b) of the worst two parts."""
    return min(2 / (2 - Fraction(1, a) - Fraction(1, b)) for a, b in parts(m) if a + b > 2)


def weights(name: str, size: int) -> list[sp.Expr]:
    """Weights of sum 1."""
    free = list(sp.symbols(f"{name}_1:{size}"))
    return [*free, 1 - sum(free)]


def variance_residual(a: int, b: int) -> sp.Expr:
    """Σα_iβ_j(x_i - y_j)² less both Σ_{i<j}α_iα_j(x_i - x_j)² and the square of the means' difference, expanded."""
    alpha, beta = weights("alpha", a), weights("beta", b)
    x, y = (list(sp.symbols(f"{name}_1:{size + 1}")) for name, size in (("x", a), ("y", b)))
    between = sum(f * g * (p - q) ** 2 for f, p in zip(alpha, x, strict=True) for g, q in zip(beta, y, strict=True))
    within = sum(
        f * g * (p - q) ** 2
        for part in (zip(alpha, x, strict=True), zip(beta, y, strict=True))
        for (f, p), (g, q) in combinations(part, 2)
    )
    means = [sum(f * p for f, p in zip(*pair, strict=True)) for pair in ((alpha, x), (beta, y))]
    return sp.expand(between - within - (means[0] - means[1]) ** 2)


def products_residual(size: int) -> sp.Expr:
    """Σ_{i<j}α_iα_j - ½(1 - 1/size) + ½Σ(α_i - 1/size)², for weights of sum 1."""
    alpha, mean = weights("alpha", size), sp.Rational(1, size)
    products = sum((f * g for f, g in combinations(alpha, 2)), sp.S.Zero)
    return sp.expand(products - (1 - mean) / 2 + sum((f - mean) ** 2 for f in alpha) / 2)


def radon_points(m: int) -> Iterator[Step]:
    """Of m + 2 points some two are so much farther apart than some two others."""
    places = sp.Matrix([*(sp.symbols(f"{axis}_1:{m + 3}") for axis in "xyz"[:m]), (1,) * (m + 2)])
    yield Step(
        f"m = {m}: {m + 2} points have weights λ ≠ 0 with Σλ_i = 0, Σλ_i q_i = 0 (more columns than rows). There are "
        "positive and negative ones: scaled to sum 1, they give two parts of the points one weighted mean",
        places.shape == (m + 1, m + 2),
    )
    yield Step(
        f"m = {m}: if the means of two parts agree, Σα_iβ_j‖x_i - y_j‖² = Σ_(i<j) α_iα_j‖x_i - x_j‖² + "
        "Σ_(i<j) β_iβ_j‖y_i - y_j‖² (coordinate by coordinate)",
        all(variance_residual(a, b) == 0 for a, b in parts(m)),
        evidence=f"expanded for parts of {', '.join(f'{a} and {b}' for a, b in parts(m))}: 0",
    )
    square = least_square(m)
    yield Step(
        f"m = {m}: the weights on the left have sum 1, those on the right at most ½(1 - 1/a) and ½(1 - 1/b): the "
        f"longest squared distance is at least {square} times the shortest",
        all(products_residual(size) == 0 for size in range(1, m + 2)) and square > 1,
        r"\textstyle\sum_{i<j}\alpha_i\alpha_j = \tfrac12(1 - \tfrac1a) - \tfrac12\sum(\alpha_i - \tfrac1a)^2",
        f"2/(2 - 1/a - 1/b) >= {square} for all parts of at most {m + 2} points",
    )


def least_ratio(points: int, m: int) -> arb | None:
    """Longest over shortest distance of so many points: at least that; None if nothing is known here.

    That of m + 2 points is proved. Cited: six and seven of the plane (Bateman and Erdős 1951), and more than five of
    space by their volume: balls of half the shortest distance about them fit into that of Jung's theorem.
    """
    if points == m + 2:
        return ball(least_square(m)).sqrt()
    if m == 1:
        return arb(points - 1)  # as many gaps side by side
    if m == 2:
        return {6: 2 * (arb(2) / 5).sin_pi(), 7: arb(2)}.get(points)
    return (arb(points).root(3) - 1) / (arb(3) / 2).sqrt()


def cited(clique: int, m: int) -> str:
    """What of `largest_clique` is not proved here, for a step's text."""
    return "" if m == 1 or clique == m + 1 else f" (the least ratio of {clique + 1} points is cited)"


def largest_clique(ratio: arb, m: int) -> int | None:
    """How many points can have all distances within a factor below `ratio`; None if that is not known."""
    for points in count(m + 2):
        least = least_ratio(points, m)
        if least is not None and ratio < least:
            return points - 1
        if (m == 2 and points > 7) or not ratio.is_finite():
            return None
    return None
