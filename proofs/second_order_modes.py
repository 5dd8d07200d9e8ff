"""A mode of a flock, x'' = -k x - d x' + w: its delay margin, and its H∞ and H₂ norms, in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from types import FunctionType, SimpleNamespace
from typing import Any

import sympy as sp
import z3

from flockana.stability.delay import scalar_margin
from proofs.proof import Proof, Step
from proofs.smt import implication, impossible

K, D, W = sp.symbols("k d W", positive=True)  # W = ω²
TAU, UNIT = sp.symbols("tau unit", positive=True)
S = sp.Symbol("s")
OMEGA = sp.sqrt(W)
SQUARE = (D**2 + sp.sqrt(D**4 + 4 * K**2)) / 2  # ω² where a root crosses
CROSSING = W**2 - D**2 * W - K**2  # |ω²|² - |k + jωd|²
COSINE, SINE = K / W, OMEGA * D / W  # of ωτ


def library_margin() -> tuple[Any, Any]:
    """(τ*, ω) of the library's code, executed on symbols, whatever frequency it takes for a unit."""
    positive = {"hypot": lambda a, b: sp.sqrt(a**2 + b**2), "arctan2": lambda y, x: sp.atan(y / x)}
    numpy = SimpleNamespace(sqrt=sp.sqrt, **positive)
    known = {"np": numpy, "float": sp.nsimplify, "inf": inf, "DelayMargin": lambda delay, omega: (delay, omega)}
    known["max"] = lambda *_: UNIT
    known["ensure_nonnegative"] = lambda name, symbol: symbol  # as it is declared to be
    delay, omega = FunctionType(scalar_margin.__code__, known)(K, D)
    return sp.simplify(delay), sp.simplify(omega)


def inverse_speed() -> sp.Expr:
    """1/(ds/dτ) of a root of F = s² + (k + ds)e^(-sτ), where e^(-sτ) = -s²/(k + ds)."""
    late = sp.Function("E")(S, TAU)
    f = S**2 + (K + D * S) * late
    by_s = f.diff(S).subs(late.diff(S), -TAU * late)
    by_tau = f.diff(TAU).subs(late.diff(TAU), -S * late)
    return sp.simplify((-by_s / by_tau).subs(late, -(S**2) / (K + D * S)))


def _delay() -> Iterator[Step]:
    on_axis = -W + (K + sp.I * OMEGA * D) * (COSINE - sp.I * SINE)
    other = (D**2 - sp.sqrt(D**4 + 4 * K**2)) / 2
    yield Step(
        "s = jω is a root of s² + (k + ds)e^(-sτ) only if ω⁴ = k² + ω²d²: there is one such ω² > 0, and it is the "
        "library's",
        sp.expand(CROSSING.subs(W, SQUARE)) == 0
        and sp.expand((W - SQUARE) * (W - other) - CROSSING) == 0
        and sp.simplify(SQUARE * other + K**2) == 0
        and sp.simplify(library_margin()[1] ** 2 - SQUARE) == 0,
        r"\omega^2 = \tfrac12\bigl(d^2 + \sqrt{d^4 + 4k^2}\bigr)",
        "the product of the two is -k² < 0",
    )
    yield Step(
        "there it is one if cos ωτ = k/ω² and sin ωτ = d/ω, which are a cosine and a sine, both > 0",
        sp.simplify(sp.expand(on_axis) * W + CROSSING) == 0
        and sp.simplify((COSINE**2 + SINE**2 - 1) * W**2 + CROSSING) == 0,
    )
    yield Step(
        "so the first τ is atan2(ωd, k)/ω, in (0, π/2ω), the library's; the others are whole periods 2π/ω later",
        sp.simplify(library_margin()[0] * library_margin()[1] - sp.atan(library_margin()[1] * D / K)) == 0,
        r"\tau^* = \tfrac1\omega\operatorname{atan2}(\omega d, k)",
    )
    speed = sp.re(sp.expand_complex(inverse_speed().subs(S, sp.I * OMEGA)))
    claimed = 2 / W - D**2 / (K**2 + D**2 * W)
    yield Step(
        "each crossing is of a simple root and to the right: Re 1/(ds/dτ) = (2ω² - d²)/ω⁴ = √(d⁴ + 4k²)/ω⁴ > 0",
        sp.simplify(speed - claimed) == 0 and sp.expand((2 * SQUARE - D**2) ** 2 - (D**4 + 4 * K**2)) == 0,
        r"\operatorname{Re}\Bigl(\frac{ds}{d\tau}\Bigr)^{-1} = \frac{2\omega^2 - d^2}{\omega^4} > 0",
        "k² + d²ω² = ω⁴",
    )
    k, d, x, y, r = z3.Reals("k d x y r")
    yield impossible(
        "without a delay all roots of s² + ds + k are on the left",
        *(k > 0, d > 0, x >= 0, x * x - y * y + d * x + k == 0, 2 * x * y + d * y == 0),
    )
    yield implication(
        "whatever the delay, a root s with Re s >= 0 has |s|² <= k + d|s|, so |s| <= ½(d + √(d² + 4k)): none comes "
        "from infinity",
        z3.Or(2 * r <= d, (2 * r - d) * (2 * r - d) <= d * d + 4 * k),
        *(k > 0, d > 0, r >= 0, r * r <= k + d * r),
    )


def _norms() -> Iterator[Step]:
    w = sp.Symbol("w", nonnegative=True)  # ω²
    inverse = sp.expand((K - w) ** 2 + D**2 * w)
    peak = D**2 * (K - D**2 / 4)
    yield Step(
        "|s² + ds + k|² on the axis is (ω² - (k - ½d²))² + d²(k - ¼d²): if d² <= 2k the H∞ norm is 1/(d√(k - ¼d²)), "
        "at ω² = k - ½d²",
        sp.expand(inverse - (w - (K - D**2 / 2)) ** 2 - peak) == 0,
        r"\|G\|_\infty = \frac{1}{d\sqrt{k - d^2/4}}",
    )
    k, d, square = z3.Reals("k d w")
    yield implication(
        "else it is 1/k, at rest",
        (k - square) * (k - square) + d * d * square >= k * k,
        *(k > 0, d > 0, square >= 0, d * d >= 2 * k),
    )
    a, b = sp.Matrix([[0, 1], [-K, -D]]), sp.Matrix([0, 1])
    gramian = sp.diag(1 / (2 * D * K), 1 / (2 * D))
    yield Step(
        "the Gramian of a force is diag(1/(2dk), 1/(2d)): the H₂ norm is 1/√(2dk)",
        (a * gramian + gramian * a.T + b * b.T).applyfunc(sp.simplify) == sp.zeros(2, 2),
        r"AP + PA^\top + BB^\top = 0",
    )


def _steps() -> Iterator[Step]:
    yield from _delay()
    yield from _norms()


PROOF = Proof(
    id="second-order-modes",
    title="A mode's delay margin and norms",
    statement=(
        "x'' = -k x(t-τ) - d x'(t-τ) is asymptotically stable for τ < τ* = atan2(ωd, k)/ω, ω² = ½(d² + √(d⁴ + 4k²)), "
        "has a pair of roots ±jω at τ*, and is unstable beyond; the library's closed form is this. From w, "
        "x'' + d x' + k x = w has the H∞ norm 1/(d√(k - ¼d²)) if d² <= 2k and 1/k else, and the H₂ norm 1/√(2dk)."
    ),
    hypotheses=(
        "k, d > 0: of a flock these are its modes where stiffness and damping have common eigenvectors. Roots depend "
        "continuously on τ (not checked by a machine)"
    ),
    rigour="smt",
    theorems=("delay-margin",),
    steps=_steps,
    size=9,
)
