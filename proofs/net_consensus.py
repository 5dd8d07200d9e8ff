"""Second-order consensus on a digraph: which positions and velocities agree, by the eigenvalues of the Laplacian."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication, real

A, B, X, Y = sp.symbols("alpha beta x y", real=True)  # the gains, and μ = x + jy
S, W = sp.Symbol("s"), sp.Symbol("omega", real=True)


def quartic() -> sp.Poly:
    """The modes of μ and of its conjugate: |s² + (α + βs)μ|² for real s, a real polynomial."""
    mode = S**2 + (A + B * S) * (X + sp.I * Y)
    return sp.Poly(sp.expand(mode * mode.subs(sp.I, -sp.I)), S)


def _modes() -> Iterator[Step]:
    mu = sp.Symbol("mu")
    block = sp.Matrix([[0, 1], [-A * mu, -B * mu]])
    yield Step(
        "on a Jordan chain of L the system is block triangular, with the blocks [[0, 1], [-αμ, -βμ]]: its poles are "
        "the roots of s² + (α + βs)μ over the eigenvalues μ",
        sp.expand(block.charpoly(S).as_expr() - (S**2 + (A + B * S) * mu)) == 0,
        r"s^2 + (\alpha + \beta s)\mu = 0",
    )
    weight, re, im = z3.Reals("weight x y")
    yield implication(
        "every μ lies in the disc about the sum of a row with that sum as radius (Gershgorin): Re μ >= 0, and > 0 but "
        "for μ = 0, which is simple exactly if one agent is heard by all (a rooted net; cited)",
        z3.Or(re > 0, z3.And(re == 0, im == 0)),
        *(weight >= 0, (re - weight) * (re - weight) + im * im <= weight * weight),
    )


def _criterion() -> Iterator[Step]:
    leading, *rest = quartic().all_coeffs()
    a3, a2, a1, a0 = (sp.expand(each) for each in rest)
    third = sp.factor(a3 * a2 * a1 - a1**2 - a3**2 * a0)
    criterion = B**2 * X * (X**2 + Y**2) - A * Y**2
    cofactor = sp.cancel(third / criterion)
    yield Step(
        "of the quartic |s² + (α + βs)μ|² Hurwitz's determinant a3 a2 a1 - a1² - a3² a0 is a positive factor times "
        "β²x|μ|² - αy²",
        leading == 1 and sp.expand(cofactor * criterion - third) == 0 and sp.expand(cofactor - _positive()) == 0,
        r"\Delta_3 \propto \beta^2 x |\mu|^2 - \alpha y^2",
        f"factor {sp.factor(cofactor)}",
    )
    alpha, beta, x, y = z3.Reals("alpha beta x y")
    names = {A: alpha, B: beta, X: x, Y: y}
    known = (alpha > 0, beta > 0, x > 0)
    factor = real(sp.expand(_positive()), names)
    yield implication("that factor is positive for α, β, Re μ > 0", factor > 0, *known)
    yield implication(
        "and so are a3, a1 and a0: by Hurwitz's criterion both modes are stable exactly if β²/α > y²/(x|μ|²)",
        z3.And(*(real(each, names) > 0 for each in (a3, a1, a0))),
        *(*known, beta * beta * x * (x * x + y * y) - alpha * y * y > 0),
        latex=r"\frac{\beta^2}{\alpha} > \frac{\operatorname{Im}^2\mu}{\operatorname{Re}\mu\,|\mu|^2}",
    )
    at = sp.expand((S**2 + (A + B * S) * (X + sp.I * Y)).subs(S, sp.I * W))
    yield Step(
        "at equality there is a pole on the axis, at ω = -αy/(βx), or its conjugate: that start swings for ever",
        sp.simplify(sp.expand(at.subs(W, -A * Y / (B * X)) * B**2 * X**2).subs(A, B**2 * X * (X**2 + Y**2) / Y**2))
        == 0,
    )


def _positive() -> sp.Expr:
    """The factor of Hurwitz's determinant."""
    return 4 * A * B**2 * (X**2 + Y**2)


def _agreement() -> Iterator[Step]:
    laplacian = _laplacian(3, [(i, j) for i in range(3) for j in range(3) if i != j])
    left = sp.Matrix([laplacian.cofactor(i, i) for i in range(3)]).T
    yield Step(
        "the left eigenvector w of 0 holds the principal cofactors of L, so Σ w_i u_i = 0: Σ w_i p_i stays, Σ w_i q_i "
        "moves evenly, and all tend to that motion (checked: three agents, any weights)",
        (left * laplacian).applyfunc(sp.expand) == sp.zeros(1, 3),
        r"w^\top L = 0",
    )
    one, two = sp.symbols("q_1 q_2", real=True)
    parted = _laplacian(4, [(0, 1), (1, 0), (2, 3), (3, 2)])
    yield Step(
        "without a root two groups hear nobody outside: each at rest in a place of its own, they stay (checked: two "
        "groups of two)",
        (parted * sp.Matrix([one, one, two, two])).applyfunc(sp.expand) == sp.zeros(4, 1),
    )


def _laplacian(n: int, edges: list[tuple[int, int]]) -> sp.Matrix:
    """L of any weights on the given edges (i, j), where i hears j."""
    matrix = sp.zeros(n)
    for i, j in edges:
        weight = sp.Symbol(f"a_{i}{j}", positive=True)
        matrix[i, j], matrix[i, i] = -weight, matrix[i, i] + weight
    return matrix


def _steps() -> Iterator[Step]:
    yield from _modes()
    yield from _criterion()
    yield from _agreement()


PROOF = Proof(
    id="net-consensus",
    title="Second-order consensus on a digraph",
    statement=(
        "Under u = -L(αq + βp) on a fixed digraph positions and velocities agree from every start exactly if one agent "
        "is heard by all and β²/α > Im²μ/(Re μ |μ|²) for each eigenvalue μ ≠ 0 of L; at equality they do not."
    ),
    hypotheses="α, β > 0; weights >= 0. Cited: Gershgorin's discs; 0 is a simple eigenvalue exactly on rooted nets",
    rigour="smt",
    theorems=("net-consensus",),
    steps=_steps,
    size=8,
)
