"""The library's scalar functions are the proved formulas: their own code, executed on symbols, and compared.

Kernels of the α- and β-pair are generated from sympy expressions, of which some are rearranged. Other kernels are plain
functions of Python; their code runs on symbols of sympy, with sympy's root. Numbers in it count with their binary
values. What is left is rounding, and guards against overflow that no flock meets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import factorial, pi
from types import FunctionType
from typing import Any

import sympy as sp
from flint import arb, ctx

from flockana.certified.decimal_rounding import small
from flockana.jit import Inlined
from flockana.kernels import sine_and_cosine
from flockana.sources.li_dead_zone.kernels import pair as dead_zone_kernel
from flockana.sources.li_dead_zone.symbolic import D_1, D_2, ETA, K_1, K_DELTA, K_R, R_D, RHO, R, force
from flockana.symbolic.named_functions import TINY, Named, Phi, PhiIntegral, SigmaNorm
from proofs.dead_zone_pairs import zones
from proofs.proof import Proof, Step

DIGITS = 30
TERMS = 10  # of the sine's series after the first
STATED = {"error": "2.0e-16"}


class _Endless:
    """In place of ∞, which nothing reaches."""

    def __gt__(self, other: object) -> bool:
        return True


_ROOTS: dict[str, Any] = {"sqrt": sp.sqrt, "pi": sp.pi, "inf": _Endless()}


def on_symbols(function: Any, **others: Any) -> Callable[..., Any]:
    """A kernel's code as it stands, with sympy's functions and `others` in place of those that it names."""
    source = function.function
    known = {**source.__globals__, **_ROOTS}
    for name in source.__code__.co_names:
        if isinstance(known.get(name), Inlined) and name not in others:
            known[name] = on_symbols(known[name], **others)
    code = FunctionType(source.__code__, {**known, **others}, source.__name__)
    return lambda *arguments: binary(sp.sympify(code(*arguments)))


def binary(expression: Any) -> Any:
    """Every float as the binary fraction that it is; 1e-300, which only keeps 0/0 out, as 0."""
    if isinstance(expression, (tuple, sp.Tuple)):
        return tuple(map(binary, expression))
    floats = {x: sp.S.Zero if abs(x) < 1e-299 else sp.Rational(float(x)) for x in expression.atoms(sp.Float)}
    return expression.xreplace(floats)


def force_residual(zone: dict[sp.Symbol, sp.Expr], *, ramp: sp.Expr = sp.S.Zero) -> sp.Expr:
    """The library's force of a dead-zone pair less the proved one, in a zone."""
    place = {**zone, R_D: zone[R] + sp.Symbol("E", positive=True)}
    kernel = dead_zone_kernel
    given = {kernel.ETA: ETA, kernel.K_R: K_R, kernel.K_DELTA: K_DELTA, kernel.K_1: K_1, kernel.RAMP: ramp}
    given |= {kernel.D_1: place[D_1], kernel.D_2: place[D_2], kernel.R: place[R], kernel.R_D: place[R_D]}
    found = on_symbols(kernel.force)(RHO, [given.get(k, sp.S.Zero) for k in range(11)])
    return sp.simplify(found - force(ramp=ramp).subs(place, simultaneous=True).doit())


def sine_error() -> arb:
    """How far the library's taper can be from ρ_h, before rounding: sin² of its series against that of the sine."""
    half = arb.pi() / 2
    total, power = half ** (2 * TERMS + 3) / factorial(2 * TERMS + 3), half  # the rest of an alternating series
    for k in range(1, TERMS + 1):
        power *= half * half
        term = arb(1) / factorial(2 * k + 1)
        total += abs(abs(arb(getattr(sine_and_cosine, f"_S{k}"))) - term) * power
    ends = abs(arb(pi) / 2 - half)  # π of the library is a float: the argument is off by that at most
    return 2 * (total + ends) + (total + ends) ** 2


def rearranged(node: Named) -> sp.Expr:
    """The form of a function that is compiled less the printed one, in all its pieces: 0."""

    def form(each: sp.Expr) -> sp.Expr:
        return each.stable if isinstance(each, Named) else each

    stable = form(node).replace(lambda each: isinstance(each, Named), form).subs(TINY, 0)
    return sp.simplify(stable - node.formula)


def _sines() -> Iterator[Step]:
    x = sp.Symbol("x", real=True)
    series = sum((sp.Rational((-1) ** k, factorial(2 * k + 1)) * x ** (2 * k + 1) for k in range(TERMS + 1)), sp.S.Zero)
    exact = {f"_S{k}": sp.Rational((-1) ** k, factorial(2 * k + 1)) for k in range(1, TERMS + 1)}
    yield Step(
        f"the sine of the library is its series to x^{2 * TERMS + 1}",
        sp.expand(on_symbols(sine_and_cosine.quarter_sine, **exact)(x) - series) == 0,
    )
    close = [sp.Rational(getattr(sine_and_cosine, f"_S{k}")) - exact[f"_S{k}"] for k in range(1, TERMS + 1)]
    y = sp.Symbol("y", positive=True)
    yield Step(
        "ρ_h(z) = ½(1 + cos πt) = sin² ½π(1 - t), t = (z - h)/(1 - h)",
        sp.simplify((1 + sp.cos(sp.pi * y)) / 2 - sp.sin(sp.pi * (1 - y) / 2) ** 2) == 0,
    )
    with ctx.workdps(DIGITS):
        error = sine_error()
        yield Step(
            "taper: its floats are the coefficients to half a unit, and so it is off by no more than this, all "
            "z, all h",
            all(abs(one) <= abs(value) / 2**53 for one, value in zip(close, exact.values(), strict=True)),
            evidence=f"{small(error)}, before rounding",
            found={"error": small(error)},
        )


def _steps() -> Iterator[Step]:
    a, y, c, eps = sp.symbols("a y c epsilon", positive=True)
    b = a * (1 + 2 * c * (c + sp.sqrt(1 + c**2)))
    yield Step("σ-norm: the compiled x²/(√(1 + εx²) + 1) is the printed formula", rearranged(SigmaNorm(y, eps)) == 0)
    yield Step("b in terms of c = (b - a)/√(4ab)", sp.simplify((b - a) ** 2 - 4 * a * b * c**2) == 0)
    for sign in (1, -1):
        place = (sign * y - c, a, b, c)
        yield Step(
            f"φ and ∫φ, s + c {'>' if sign > 0 else '<'} 0: the compiled forms, which cancel nothing, are the printed",
            rearranged(Phi(*place)) == 0 and rearranged(PhiIntegral(*place)) == 0,
        )
    yield from _sines()
    for wide in (False, True):
        for name, zone in zones(wide=wide).items():
            yield Step(
                f"dead zone, d₂ {'>=' if wide else '<'} r, {name}: the library's force is the proved formula",
                force_residual(zone) == 0,
            )


PROOF = Proof(
    id="library-formulas",
    title="What the library computes are the proved formulas",
    statement=(
        "The forms of σ-norm, φ and ∫φ from which kernels are generated are the printed formulas, and the code of the "
        "dead-zone force, executed on symbols, is the formula that the proofs are "
        f"of; that of the bump is off by at most {STATED['error']}, everywhere and for every h, before rounding."
    ),
    hypotheses="arguments below 1e100; rounding and 1e-300 left out; 0 < a < b; the force without a ramp",
    rigour="interval",
    steps=_steps,
    size=14,
    values=STATED,
)
