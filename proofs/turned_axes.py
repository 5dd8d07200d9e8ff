"""Erratum L1: a product of two vectors by components depends on the axes; one direction and one sum do not."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from flockana.sources.li_dead_zone.symbolic import RHO, direction
from proofs.proof import Proof, Step

X, Y, ANGLE = sp.symbols("x y theta", real=True)
F = sp.Function("f")  # any action
TURN = sp.Matrix([[sp.Rational(3, 5), -sp.Rational(4, 5)], [sp.Rational(4, 5), sp.Rational(3, 5)]])


def pair_direction(gap: sp.Matrix) -> sp.Matrix:
    """n of a pair: the library's length of it, along q_j - q_i."""
    rho = sp.sqrt(gap.dot(gap))
    return direction(RHO).subs(RHO, rho) / rho * gap


def printed(gap: sp.Matrix) -> sp.Matrix:
    """(f n) times n by components, of a pair: what (7) in (9) leaves."""
    n = pair_direction(gap)
    return F(gap.dot(gap)) * n.multiply_elementwise(n)


def corrected(gap: sp.Matrix) -> sp.Matrix:
    """Return f n."""
    return F(gap.dot(gap)) * pair_direction(gap)


def _steps() -> Iterator[Step]:
    gap = sp.Matrix([sp.Symbol("rho", positive=True), 0])
    change = (printed(TURN * gap) - TURN * printed(gap)).applyfunc(sp.simplify)
    size = sp.simplify(printed(gap)[0])
    yield Step(
        "two agents, axes turned by the angle of 3, 4, 5: the printed force changes by (-6/25, -4/25) of itself",
        [sp.simplify(part / size) for part in change] == [-sp.Rational(6, 25), -sp.Rational(4, 25)],
        r"\bigl(\tfrac9{25}, \tfrac{16}{25}\bigr) \ne \bigl(\tfrac35, \tfrac45\bigr)",
    )
    turn = sp.Matrix([[sp.cos(ANGLE), -sp.sin(ANGLE)], [sp.sin(ANGLE), sp.cos(ANGLE)]])
    gap = sp.Matrix([X, Y])
    square = sp.simplify((turn * gap).dot(turn * gap))
    yield Step(
        "f n turns with the axes, for every pair, angle and action: the distance is the same, and n is a multiple of "
        "the gap; so do sums of it",
        square == X**2 + Y**2
        and sp.simplify(corrected(turn * gap).subs((turn * gap).dot(turn * gap), square) - turn * corrected(gap))
        == sp.zeros(2, 1),
        r"f(\rho)\,n(R\,\Delta) = R\,f(\rho)\,n(\Delta)",
    )


PROOF = Proof(
    id="turned-axes",
    title="Erratum L1: a product of two vectors by components depends on the axes",
    statement=(
        "Read by components, the force of (7) in (9) on one of two agents does not turn with the axes, whatever the "
        "action f ≠ 0; with f and n once it does."
    ),
    hypotheses="m = 2",
    rigour="symbolic",
    steps=_steps,
    size=2,
    theorems=("L1",),
)
