"""A swarm of first order with linear attraction and Gaussian repulsion: centroid, final ball, collapse."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication

_A, _B, _C, _S = sp.symbols("a b c s", positive=True)
_PEAK = sp.sqrt(_C / 2) * sp.exp(sp.Rational(-1, 2))


def _pull(x: sp.Matrix) -> sp.Matrix:
    """Return what a difference x = q_j - q_i adds to the velocity of i."""
    return (_A - _B * sp.exp(-x.dot(x) / _C)) * x


def _identities() -> Iterator[Step]:
    q = [sp.Matrix(sp.symbols(f"x{i} y{i}", real=True)) for i in range(3)]
    v = [sum((_pull(other - own) for other in q if other is not own), sp.zeros(2, 1)) for own in q]
    yield Step(
        "what j adds to i and i adds to j cancels, so the centroid does not move (checked: three agents in the plane)",
        sp.simplify(sum(v, sp.zeros(2, 1))) == sp.zeros(2, 1),
        r"\sum_i \dot q_i = 0",
    )
    pairs = [q[j] - q[i] for i in range(3) for j in range(i)]
    energy = sum(_A * x.dot(x) / 2 + _B * _C * sp.exp(-x.dot(x) / _C) / 2 for x in pairs)
    slopes = [sp.Matrix([energy.diff(x) for x in own]) for own in q]
    yield Step(
        "velocities are minus the gradient of J = Σ_{i<j} (a ‖y‖² + bc exp(-‖y‖²/c))/2 >= 0: J falls at Σ‖v‖², and on "
        "a bounded set v is uniformly continuous, so that v -> 0 (Barbalat)",
        all(sp.simplify(slope + own) == sp.zeros(2, 1) for slope, own in zip(slopes, v, strict=True)),
        r"\dot q_i = -\nabla_i J",
    )
    centre = sum(q, sp.zeros(2, 1)) / 3
    linear = [sum((_A * (other - own) for other in q), sp.zeros(2, 1)) + 3 * _A * (own - centre) for own in q]
    yield Step(
        "attraction alone is -aM e_i, e_i = q_i - q_c",
        all(sp.simplify(each) == sp.zeros(2, 1) for each in linear),
        r"\sum_j a (q_j - q_i) = -a M e_i",
    )
    rate = sum((own - centre).dot(one) for own, one in zip(q, v, strict=True))
    by_pairs = sum((_B * sp.exp(-x.dot(x) / _C) - _A) * x.dot(x) for x in pairs)
    yield Step(
        "½ Σ‖e_i‖² changes at Σ_{i<j} (b exp(-‖y‖²/c) - a) ‖y‖²",
        sp.simplify(rate - by_pairs) == 0,
        r"\tfrac{d}{dt}\tfrac12\sum\|e_i\|^2 = \sum_{i<j}(b e^{-\|y\|^2/c} - a)\|y\|^2",
    )


def _ball() -> Iterator[Step]:
    push = _S * sp.exp(-(_S**2) / _C)
    slope = sp.simplify(push.diff(_S) * sp.exp(_S**2 / _C))
    yield Step(
        "s exp(-s²/c) rises up to s = √(c/2) and falls beyond: it is at most √(c/2) e^-½",
        sp.simplify(slope - (1 - 2 * _S**2 / _C)) == 0 and sp.simplify(push.subs(_S, sp.sqrt(_C / 2)) - _PEAK) == 0,
        r"s e^{-s^2/c} \le \sqrt{c/2}\,e^{-1/2}",
    )
    a, b, count, most, size, bound = z3.Reals("a b M mu D rho")
    yield implication(
        "so ‖e_i‖' <= -aM ‖e_i‖ + (M - 1) b μ = -aM (‖e_i‖ - ρ'), ρ' = (M - 1)/M (b/a) μ: what exceeds ρ' falls at aM, "
        "and ρ' < ρ = (b/a) μ",
        z3.And(-a * count * size + (count - 1) * b * most == -a * count * (size - bound), bound < b / a * most),
        *(a > 0, b > 0, most > 0, count >= 1, size >= 0, bound * a * count == (count - 1) * b * most),
        latex=r"\tfrac{d}{dt}\|e_i\| \le -aM(\|e_i\| - \rho')",
    )
    rest = sp.sqrt(_C * sp.log(_B / _A))
    at = rest.subs(_B, _A * sp.exp(sp.Rational(1, 2)))
    yield Step(
        "two agents rest √(c ln(b/a)) apart if b > a; at b = a √e each is ρ' = ρ/2 from the centroid: it is sharp",
        sp.simplify(_A - _B * sp.exp(-(rest**2) / _C)) == 0
        and sp.simplify(at / 2 - (_A * sp.exp(sp.Rational(1, 2)) / _A) * _PEAK / 2) == 0,
        r"\tfrac12\sqrt{c \ln\sqrt e} = \tfrac12 \tfrac ba \sqrt{c/2}\,e^{-1/2}",
    )


def _sides() -> Iterator[Step]:
    a, b, fall, square, other = z3.Reals("a b E y2 E0")
    yield implication(
        "0 < exp(-‖y‖²/c) < 1 for y ≠ 0: if b <= a each pair's (b exp - a) ‖y‖² is negative, so that ½ Σ‖e‖² falls "
        "unless all are at one point; level sets are compact, all tend to that point (LaSalle)",
        (b * fall - a) * square < 0,
        *(a > 0, b > 0, b <= a, fall > 0, fall < 1, square > 0),
    )
    yield implication(
        "b > a: within any distance below √(c ln(b/a)) exp(-‖y‖²/c) >= E0 > a/b, and ½ Σ‖e‖² grows at a rate "
        "2M (b E0 - a) > 0 at least: all distances cannot stay there, unless all agents began at one point",
        z3.And((b * fall - a) * square >= (b * other - a) * square, b * other - a > 0),
        *(a > 0, b > a, fall >= other, other > a / b, square >= 0),
    )


def _steps() -> Iterator[Step]:
    yield from _identities()
    yield from _ball()
    yield from _sides()


PROOF = Proof(
    id="gazi-passino",
    title="A swarm with linear attraction and Gaussian repulsion",
    statement=(
        "Under q_i' = Σ_j (a - b exp(-‖q_j - q_i‖²/c))(q_j - q_i) the centroid stays, velocities tend to 0, and what "
        "exceeds (M - 1)/M (b/a) √(c/2) e^-½ of a distance from the centroid dies out at aM; all end at one point if "
        "b <= a, and if b > a none do that did not start so."
    ),
    hypotheses="a, b, c > 0; M agents in any dimension",
    rigour="smt",
    theorems=("gazi-passino",),
    steps=_steps,
    size=9,
    cites=("Barbalat", "LaSalle"),
)
