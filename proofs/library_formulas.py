"""The library's scalar functions are the proved formulas: their own code, executed on symbols, and compared.

What numba compiles are plain functions of Python; the same code runs on symbols of sympy, with sympy's root. Numbers in
it count with their binary values. What is left is rounding, and two guards against overflow that no flock meets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import factorial, pi
from types import FunctionType
from typing import Any

import sympy as sp
from flint import arb, ctx

from flockana.certified.decimals import small
from flockana.jit import Inlined
from flockana.kernels import dead_zone as dead_zone_kernel
from flockana.kernels import scalars
from flockana.symbolic.dead_zone import D_1, D_2, ETA, K_1, K_DELTA, K_R, R_D, RHO, R, force
from flockana.symbolic.functions import taper
from flockana.symbolic.norms import sigma_1, sigma_norm
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


def below_overflow(x: Any) -> sp.Expr:
    """In place of |x| where a function asks whether x would overflow: it would not."""
    return sp.S.Zero


def phi_residual(sign: int) -> sp.Expr:
    """The library's φ(s) - ½(a + b)(σ₁(s + c) - σ₁(c)), s + c of this sign: 0."""
    a, b, y = sp.symbols("a b y", positive=True)
    c = sp.Symbol("c", nonnegative=True)
    above, below = on_symbols(scalars.phi_parts, abs=sp.Abs)(sign * y - c, a, b, c)
    return sp.simplify(above / below - (a + b) / 2 * (sigma_1(sign * y) - sigma_1(c)))


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
        total += abs(abs(arb(getattr(scalars, f"_S{k}"))) - term) * power
    ends = abs(arb(pi) / 2 - half)  # π of the library is a float: the argument is off by that at most
    return 2 * (total + ends) + (total + ends) ** 2


def _taper() -> Iterator[Step]:
    y = sp.Symbol("y", nonnegative=True)
    z, h = sp.symbols("z h", positive=True)
    series = sum((sp.Rational((-1) ** k, factorial(2 * k + 1)) * y ** (2 * k + 1) for k in range(TERMS + 1)), sp.S.Zero)
    close = [sp.Rational(getattr(scalars, f"_S{k}")) * factorial(2 * k + 1) - (-1) ** k for k in range(1, TERMS + 1)]
    coefficients = {sp.Symbol(f"S{k}"): sp.Rational((-1) ** k, factorial(2 * k + 1)) for k in range(1, TERMS + 1)}
    rest, more = sp.symbols("A B", positive=True)  # h < z < 1
    place, inner = 1 - rest, 1 - rest - more
    code = FunctionType(
        scalars.taper.function.__code__, {f"_S{k}": sp.Symbol(f"S{k}") for k in range(1, TERMS + 1)} | {"pi": sp.pi}
    )
    found = binary(sp.sympify(code(place, inner))).subs(coefficients)
    argument = sp.pi / 2 * (1 - place) / (1 - inner)
    yield Step(
        f"taper: its polynomial is the square of the series of the sine, to y^{2 * TERMS + 1}, y = ½π(1 - z)/(1 - h)",
        sp.simplify(sp.expand(found) - sp.expand(series.subs(y, argument) ** 2)) == 0,
    )
    angle = sp.pi * (z - h) / (1 - h)
    yield Step(
        "and ρ_h(z) = ½(1 + cos πt) = sin² ½π(1 - t), t = (z - h)/(1 - h)",
        sp.simplify(taper(z, h=h) - (1 + sp.cos(angle)) / 2) == 0
        and sp.simplify((1 + sp.cos(sp.pi * y)) / 2 - sp.sin(sp.pi * (1 - y) / 2) ** 2) == 0,
    )
    with ctx.workdps(DIGITS):
        error = sine_error()
        yield Step(
            "taper: its floats are the coefficients to half a unit, and so it is off by no more than this, all "
            "z, all h",
            all(abs(one) <= sp.Rational(1, 2**53) for one in close),
            evidence=f"{small(error)}, before rounding",
            found={"error": small(error)},
        )


def _steps() -> Iterator[Step]:
    x, eps, s = sp.Symbol("x", positive=True), sp.Symbol("epsilon", positive=True), sp.Symbol("s", real=True)
    yield Step(
        "σ-norm: the library's x²/(√(1 + εx²) + 1) is the proved formula",
        sp.simplify(on_symbols(scalars.sigma_norm)(x**2, eps) - sigma_norm(x, eps=eps)) == 0,
    )
    yield Step("σ₁: likewise", sp.simplify(on_symbols(scalars.sigma_1, abs=below_overflow)(s) - sigma_1(s)) == 0)
    for sign in (1, -1):
        yield Step(
            f"φ, s + c {'>' if sign > 0 else '<'} 0: the library's fraction is ½(a + b)(σ₁(s + c) - σ₁(c))",
            phi_residual(sign) == 0,
        )
    a, k = sp.Symbol("a", positive=True), sp.Symbol("k", nonnegative=True)
    square = k**2 / (4 * a * (a + k))
    yield Step(
        "which is φ: (a + b)σ₁(c) = b - a for c = (b - a)/√(4ab), as squares agree and both are nonnegative, b = a + k",
        sp.simplify((2 * a + k) ** 2 * square / (1 + square) - k**2) == 0,
    )
    yield from _taper()
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
        "The code of σ-norm, σ₁, φ and of the dead-zone force, executed on symbols, is the formula that the proofs are "
        f"of; that of the bump is off by at most {STATED['error']}, everywhere and for every h, before rounding."
    ),
    hypotheses="arguments below 1e100; rounding and 1e-300 left out; 0 < a <= b; the force without a ramp",
    rigour="interval",
    steps=_steps,
    size=15,
    values=STATED,
)
