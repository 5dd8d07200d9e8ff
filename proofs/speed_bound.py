"""Erratum J7: the velocity bound (10), applied to the state in every step, is a drag, and which speed it leaves."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from types import FunctionType

import sympy as sp
import z3
from flint import arb, ctx

from flockana.certified.balls import ball
from flockana.certified.decimal_rounding import interval
from flockana.sources.jond_2025.kernels import zones
from flockana.sources.jond_2025.symbolic.zone_pair import BOUND, saturation
from proofs.proof import Proof, Step
from proofs.smt import implication

DIGITS = 30
V, PUSH = sp.symbols("v a", positive=True)  # a speed, and δ u^max
LARGEST, THRUST, DESIRED, STEP = 4, 2, 3, Fraction(1, 10)  # v^max, u^max, v^d, δ of the paper
STATED = {"one step": "2.54", "lasting": "2.01"}


def library_factor() -> sp.Expr:
    """The library's factor of a speed v, its code executed on symbols, v not near 0."""
    source = zones.saturation.function
    factor: sp.Expr = FunctionType(source.__code__, {"tanh": sp.tanh, "_NEAR_ZERO": -sp.oo})(V, BOUND)
    return factor


def after(speed: arb, push: Fraction) -> arb:
    """v^max tanh((v + δ u^max)/v^max)."""
    return LARGEST * ((speed + ball(push)) / LARGEST).tanh()


def lasting(push: Fraction, places: int) -> tuple[Fraction, Fraction]:
    """Two neighbouring decimals, between which a step gains speed at the lower one and loses it at the upper one."""
    low, high = 1, LARGEST * 10**places
    at = lambda k: ball(Fraction(k, 10**places))  # noqa: E731
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if after(at(middle), push) > at(middle) else (low, middle)
    return Fraction(low, 10**places), Fraction(high, 10**places)


def _drag() -> Iterator[Step]:
    step = saturation(V + PUSH)
    yield Step(
        "the library's factor makes v into v^max tanh(v/v^max), (10)",
        sp.simplify(library_factor() * V - saturation(V)) == 0,
    )
    yield Step(
        "f(v) = v^max tanh((v + δu^max)/v^max) rises, and f(v) - v falls: its slope is -tanh² < 0; f(0) > 0 and "
        "f(v^max) < v^max, so that there is one v* with f(v*) = v*",
        sp.simplify(1 - sp.diff(step, V) - sp.tanh((V + PUSH) / BOUND) ** 2) == 0
        and saturation(PUSH).is_positive is True
        and sp.simplify(BOUND - step.subs(V, BOUND) - BOUND * (1 - sp.tanh((BOUND + PUSH) / BOUND))) == 0,
        r"1 - f'(v) = \tanh^2\frac{v + \delta u^{\max}}{v^{\max}}, \qquad \tanh < 1",
    )
    x, y, u, w, s, a = z3.Reals("x y u w s a")
    yield implication(
        "a velocity v and an input u within δu^max give a speed of at most |v| + δu^max, of which f is taken: from one "
        "step to the next speeds are at most f of themselves, and so at most v* in the limit",
        (x + u) * (x + u) + (y + w) * (y + w) <= (s + a) * (s + a),
        *(s >= 0, a >= 0, x * x + y * y == s * s, u * u + w * w <= a * a),
    )


def _numbers() -> Iterator[Step]:
    with ctx.workdps(DIGITS):
        one = after(arb(DESIRED), Fraction(0))
        yield Step(
            "without an input 3 m/s become v^max tanh(3/4) in one step",
            bool(one < DESIRED),
            evidence=interval(one),
            found={"one step": f"{int((100 * one).floor().unique_fmpz()) / 100:.2f}"},
        )
        for step in (STEP, Fraction(1, 20), Fraction(1, 100), Fraction(1, 1000)):
            below, above = lasting(THRUST * step, 4)
            gains, loses = (after(ball(x), THRUST * step) - ball(x) for x in (below, above))
            yield Step(
                f"δ = {float(step):g}: v* is between {float(below):.4f} and {float(above):.4f}, below v^d = 3",
                bool(gains > 0 > loses) and above < DESIRED,
                evidence=f"f(v) - v in {interval(gains, 9)} and {interval(loses, 9)}",
                found={"lasting": f"{-((-100 * above) // 1) / 100:.2f}"} if step == STEP else {},
            )


def _steps() -> Iterator[Step]:
    yield from _drag()
    yield from _numbers()


PROOF = Proof(
    id="speed-bound",
    title="Erratum J7: which speed the velocity bound leaves",
    statement=(
        "Applied to the velocity in every step, (10) lets no speed last above v*, the only one with v* = v^max "
        f"tanh((v* + δ u^max)/v^max). With v^max = {LARGEST}, u^max = {THRUST} and δ = {float(STEP):g} that is less "
        f"than {STATED['lasting']}, with smaller steps less still; without an input {DESIRED} become "
        f"{STATED['one step']} in one step, cut off after two decimals."
    ),
    hypotheses="0 < v^max, 0 < δ u^max; inputs of at most u^max, m = 2 (as in every dimension, by the same inequality)",
    rigour="interval",
    steps=_steps,
    size=8,
    theorems=("J7",),
    values=STATED,
)
