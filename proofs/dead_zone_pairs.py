"""One pair of the dead-zone law, for all of its parameters: its potential, where it rests, and when it parts for ever.

The parameters are k_r > 0, k_δ, k₁, k₂, η >= 0 and 0 < d₁ < r < r_d, d₁ <= d₂; the dead zone may end beyond r, d₂ >= r,
and then only k₁ attracts. Terms of z3 are made of the library's expressions, not typed again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Any

import sympy as sp
import z3
from flint import arb, ctx

from flockana.certified.balls import ball, exact
from flockana.certified.decimal_rounding import first_digits, interval
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.symbolic import (
    D_1,
    D_2,
    ETA,
    ETA_POSITIVE,
    K_1,
    K_2,
    K_DELTA,
    K_R,
    R_D,
    RHO,
    R,
    attraction,
    direction,
    force,
    jumps,
    potential,
    repulsion,
)
from proofs.evaluate import enclosed
from proofs.proof import Step
from proofs.smt import implication, lemma, real

DIGITS = 30
STIFF = 50  # k₁ with which a pair rests below d₁, the rest by default
RESTS_AT = "1.93"
_A, _B, _C, _E = sp.symbols("A B C E", positive=True)


def defaults() -> dict[sp.Symbol, sp.Rational]:
    """The library's default parameters as the decimals that they print as, no ramp."""
    law = DeadZoneFlocking()
    pair: Any = law.interaction
    values = {D_1: pair.d1, D_2: pair.d2, R: pair.r, R_D: pair.r_d, K_R: pair.k_r, K_DELTA: pair.k_delta}
    values |= {ETA: pair.eta, ETA_POSITIVE: pair.eta, K_1: pair.k1, K_2: law.k2}
    return {symbol: sp.Rational(str(value)) for symbol, value in values.items()}


def balls(values: Mapping[sp.Symbol, sp.Rational]) -> dict[sp.Expr, arb]:
    """Exact parameters at the present precision."""
    return {symbol: arb(exact(value)) for symbol, value in values.items()}


def zones(*, wide: bool) -> dict[str, dict[sp.Symbol, sp.Expr]]:
    """ρ in each zone of a pair: d₁, d₂, r in terms of it and of positive numbers; `wide` if d₂ >= r."""
    if wide:
        return {
            "below d₁": {D_1: RHO + _A, R: RHO + _A + _C, D_2: RHO + _A + _C + _B},
            "on the dead zone": {D_1: RHO - _A, R: RHO + _C, D_2: RHO + _C + _B},
            "beyond r": {R: RHO - _C, D_1: RHO - _C - _A, D_2: RHO - _C + _B},
        }
    return {
        "below d₁": {D_1: RHO + _A, D_2: RHO + _A + _B, R: RHO + _A + _B + _C},
        "on the dead zone": {D_1: RHO - _A, D_2: RHO + _B, R: RHO + _B + _C},
        "above d₂": {D_1: RHO - _A - _B, D_2: RHO - _A, R: RHO + _C},
        "beyond r": {R: RHO - _C, D_2: RHO - _C - _A, D_1: RHO - _C - _A - _B},
    }


def saturated(*, wide: bool, eta: sp.Expr) -> sp.Expr:
    """ψ̄ as the library assembles it for d₂ < r; with d₂ >= r there is no attraction, and it ends on the dead zone."""
    whole = potential(eta=eta)
    if not wide:
        return whole
    far, near, dead = whole.args[:3]
    return sp.Piecewise((dead[0].subs(RHO, R), far[1]), near, (dead[0], True))


def slope_residual(zone: Mapping[sp.Symbol, sp.Expr], *, wide: bool, eta: sp.Expr) -> sp.Expr:
    """dψ̄/dρ - F in a zone: 0."""
    place = {**zone, R_D: zone[R] + _E}
    slope = saturated(wide=wide, eta=eta).diff(RHO)
    return sp.simplify((slope - force().subs(ETA, eta)).subs(place, simultaneous=True).doit())


def potential_steps() -> Iterator[Step]:
    """The assembled potential, differentiated against the force in every zone, and continuous between them."""
    for wide in (False, True):
        case = "d₂ >= r" if wide else "d₂ < r"
        for eta in (ETA_POSITIVE, sp.S.Zero):
            for name, zone in zones(wide=wide).items():
                yield Step(
                    f"{case}, η {'> 0' if eta else '= 0'}: dψ̄/dρ = F {name}, of ψ̄ and F as the library assembles them",
                    slope_residual(zone, wide=wide, eta=eta) == 0,
                    r"\bar\psi'(\rho) = F(\rho)",
                )
        pieces = [value for value, _ in saturated(wide=wide, eta=ETA_POSITIVE).args]
        inward = [*pieces[1:], pieces[0]]
        ends = (D_1, R) if wide else (D_1, D_2, R)
        yield Step(
            f"{case}: ψ̄ is continuous at {'d₁ and r' if wide else 'd₁, d₂ and r'}, and so is H̄ along every solution",
            all(
                sp.expand((one - next_).subs(RHO, end)) == 0
                for (one, next_), end in zip(pairwise(inward), ends, strict=True)
            ),
            sp.latex(pieces[0]) if wide else "",
        )


def terms(place: str) -> dict[sp.Expr, Any]:
    """Variables of z3 for the library's symbols, the distance and its root being those of one place."""
    shared = dict(zip((K_R, K_DELTA, K_1, R_D), z3.Reals("k_r k_δ k₁ r_d"), strict=True))
    return {RHO: z3.Real(f"ρ_{place}"), sp.sqrt(1 + ETA * RHO**2): z3.Real(f"w_{place}"), **shared}


def root(place: str) -> tuple[Any, ...]:
    """That w is √(1 + ηρ²) there."""
    s, w = z3.Reals(f"ρ_{place} w_{place}")
    eta = z3.Real("η")
    return eta >= 0, s > 0, w > 0, w**2 == 1 + eta * s**2


def rest_steps() -> Iterator[Step]:
    """L8: two agents at rest within r of each other have one distance, for all parameters with k₁ > 0."""
    near, far = terms("s"), terms("t")
    (s, w_s), (t, w_t) = (list(one.values())[:2] for one in (near, far))
    kr, kd, k1 = (near[symbol] for symbol in (K_R, K_DELTA, K_1))
    roots = lemma("√(1 + ηρ²) does not fall", w_s <= w_t, *root("s"), *root("t"), s < t)
    yield roots.step
    strength_s, strength_t = real(repulsion(), near), real(repulsion(), far)
    falls = lemma(
        "2k_r/ρ² + k_δ falls, and is positive",
        z3.And(strength_s > strength_t, strength_t > 0),
        *(s > 0, s < t, kr > 0, kd >= 0),
        latex=sp.latex(repulsion()),
    )
    yield falls.step
    theta_s, theta_t, g_s, g_t, p_s, p_t = z3.Reals("θ_s θ_t g_s g_t P_s P_t")
    bracket = (g_s == k1 * w_s - theta_s * p_s, g_t == k1 * w_t - theta_t * p_t)
    rises = lemma(
        "below d₁, g = √(1 + ηρ²) F/ρ = k₁√(1 + ηρ²) - θ(2k_r/ρ² + k_δ) rises: θ = 1, or the ramp's factor, "
        "which falls",
        g_s < g_t,
        *(*bracket, k1 >= 0, w_s <= w_t, theta_t > 0, theta_t <= theta_s, theta_s <= 1, p_s > p_t, p_t > 0),
        latex=r"s < t < d_1 \implies g(s) < g(t)",
    )
    yield rises.step
    below = (force() / direction() * RHO).subs(zones(wide=False)["below d₁"], simultaneous=True).doit()
    yield Step(
        "it is the library's force: F = gρ/√(1 + ηρ²) below d₁, with θ = 1",
        sp.simplify(below - (K_1 * sp.sqrt(1 + ETA * RHO**2) - repulsion()) * RHO) == 0,
    )
    used = (roots.at(), falls.at(), rises.at({p_s: strength_s, p_t: strength_t}))
    known = (*root("s"), *root("t"), s < t, kr > 0, kd >= 0, k1 > 0, g_s == k1 * w_s - strength_s)
    known += (theta_s == 1, theta_t == 1, g_t == k1 * w_t - strength_t)
    yield implication(
        "L8, no ramp: if F <= 0 just below d₁ (= t), F < 0 all below it: there F jumps through 0, and nowhere else",
        g_s < 0,
        *(*used, *known, g_t <= 0),
    )
    yield implication(
        "that is k₁d₁²√(1 + ηd₁²) <= 2k_r + k_δd₁²",
        (g_t <= 0) == (k1 * t**2 * w_t <= 2 * kr + kd * t**2),
        *(t > 0, g_t == k1 * w_t - strength_t),
    )
    least = z3.Real("small")
    yield implication(
        "L8: else, or with a ramp, where g(d₁⁻) = k₁√(1 + ηd₁²) > 0: near 0 F < 0, as k₁ρ²√(1 + ηρ²) < 2k_r "
        "there; F is "
        "continuous and g rises, so that it has exactly one zero, below d₁",
        g_s < 0,
        *(*root("s"), kr > 0, kd >= 0, k1 > 0, g_s == k1 * w_s - strength_s),
        *(least > 0, k1 * least <= 2 * kr, s**2 * w_s < least),
    )
    yield implication(
        "L8: from d₁ up to r, r_b included, F >= k₁ρ > 0, for the attraction is not negative",
        k1 * s + theta_s * real(attraction(), near) * s / w_s > 0,
        *(*root("s"), k1 > 0, kr > 0, kd >= 0, theta_s >= 0, s < near[R_D]),
    )
    yield from _rest_of_numbers()


def is_contact(values: Mapping[sp.Symbol, sp.Rational]) -> bool | None:
    """Whether two agents without a ramp rest at d₁: k₁d₁²√(1 + ηd₁²) <= 2k_r + k_δd₁²; None if uncertain."""
    left, right = jumps()["d1"][0].subs({**values}), arb(0)
    value = enclosed(left).real
    return True if value < right else False if value > right else None


def rest_below(values: Mapping[sp.Symbol, sp.Rational]) -> arb:
    """The one zero of F below d₁, enclosed by halving: certain signs at both ends."""
    low, high = Fraction(0), Fraction(int(values[D_1].p), int(values[D_1].q))
    places = balls(values)
    while high - low > Fraction(1, 10**6):
        middle = (low + high) / 2
        value = enclosed(force(), {**places, RHO: ball(middle)}).real
        if value > 0:
            high = middle
        elif value < 0:
            low = middle
        else:
            break
    return ball(low).union(ball(high))


def _rest_of_numbers() -> Iterator[Step]:
    with ctx.workdps(DIGITS):
        yield Step("L8: by default, no ramp, they rest at d₁ = r_b - δ", is_contact(defaults()))
        stiff = defaults() | {K_1: sp.Integer(STIFF)}
        place = rest_below(stiff)
        yield Step(
            f"L8: with k₁ = {STIFF} they do not: F > 0 just below d₁, and is 0 at {RESTS_AT}…",
            None if is_contact(stiff) is None else not is_contact(stiff) and bool(place < arb(exact(stiff[D_1]))),
            evidence=f"at ρ in {interval(place, 5)}",
            found={"rests at": str(first_digits(place, 2))},
        )
