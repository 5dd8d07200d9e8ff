"""Errata J9 and J12: where an agent that heads for an obstacle, an alien or another agent comes to rest."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import sympy as sp

from flockana.sources.jond_2025.kernels import zone_obstacles
from flockana.sources.jond_2025.symbolic.zone_pair import stand_off
from proofs.library_formulas import on_symbols
from proofs.proof import Proof, Step

T, G, W, C, V, GAP = sp.symbols("t g w c v g_1", positive=True)  # g = w^ga, w = w^oa, w^ss or w^ls, v = v^d
OUTWARD, PRINTED = (SimpleNamespace(inside=k, obstacle_force=0) for k in (0, 1))  # out of an obstacle, or as printed
SLOW, MORE = sp.symbols("lambda mu", positive=True)  # rates λ and λ + μ of the approach


def approach(pushes: int) -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr], sp.Expr]:
    """d(t) - d* of an agent head on, with w and g in terms of the rates, and d*: `pushes` agents are pushed apart."""
    fast = SLOW + MORE
    known = {G: SLOW + fast, W: SLOW * fast / pushes}
    size = pushes * V / MORE
    return (
        size * (fast / SLOW * sp.exp(-SLOW * T) - SLOW / fast * sp.exp(-fast * T)),
        known,
        stand_off(drive=G).subs(
            {sp.Symbol("v^d", positive=True): V, sp.Symbol("c", positive=True): C, sp.Symbol("w", positive=True): W}
        ),
    )


def motion(pushes: int) -> list[sp.Expr]:
    """What must vanish: the equation of motion of the distance, and both conditions at the start d = c, speed v^d.

    Each agent feels v_i' = g(v^d - v_i) + w(d - c) along its own heading, and d' = -(v_1 + ...).
    """
    x, known, rest = approach(pushes)
    d = x + rest
    speed = -d.diff(T) / pushes
    equation = speed.diff(T) - (G * (V - speed) + W * (d - C))
    return [sp.simplify(part.subs(known)) for part in (equation, (d - C).subs(T, 0), (speed - V).subs(T, 0))]


def slowing(pushes: int) -> sp.Expr:
    """The speed of approach times e^((λ + μ)t) μ/v: λ + μ - λ is left at the start, and it grows."""
    x, _, _ = approach(pushes)
    return sp.expand(sp.simplify(-x.diff(T) * MORE / (pushes * V) * sp.exp((SLOW + MORE) * T)))


def _push() -> Iterator[Step]:
    push = on_symbols(zone_obstacles.push)
    distance = C - GAP  # 0 < d < c
    yield Step(
        "the library's push along b, which points from the agent to the boundary: d - c < 0 outside, within c of it",
        sp.expand(push(distance, C, False, OUTWARD) + GAP) == 0 and (-GAP).is_negative is True,
    )
    yield Step(
        "inside an obstacle or beyond a wall b points outwards, and the printed d - c < 0 pushes further in",
        sp.expand(push(distance, C, True, PRINTED) + GAP) == 0 and (-GAP).is_negative is True,
        r"(8): \quad (d - c)\,b,\qquad d < c",
    )
    d = sp.Symbol("d", positive=True)
    yield Step(
        "with d + c > 0 it is pushed out",
        sp.expand(push(d, C, True, OUTWARD) - (d + C)) == 0 and (d + C).is_positive is True,
    )


def _head_on() -> Iterator[Step]:
    for pushes, what, condition in ((1, "a wall, or an alien at rest", "4w"), (2, "another agent alike", "8w")):
        yield Step(
            f"head on at {what}, from the distance c at the speed v^d: d - d* is a sum of two exponentials of rates "
            f"λ < λ + μ, where g = 2λ + μ and w = λ(λ + μ){'' if pushes == 1 else '/2'}, that is g² > {condition}",
            all(part == 0 for part in motion(pushes)),
            r"d^* = c - v^d\, w^{ga}/w",
            "equation of motion, distance and speed at the start: 0",
        )
        yield Step(
            "the speed of approach stays positive: the agent comes to d*, never turns, and never gets there",
            sp.expand(slowing(pushes) - ((SLOW + MORE) * sp.exp(MORE * T) - SLOW)) == 0
            and sp.expand((SLOW + MORE) * (1 + GAP) - SLOW).is_positive is True,
            r"-\dot d \propto (\lambda + \mu)e^{\mu t} - \lambda > 0",
            "e^(μt) >= 1, written as 1 + g₁",
        )
    printed = stand_off(desired_speed=3, drive=5, weight=5).subs(sp.Symbol("c", positive=True), 3)
    yield Step("with the printed 5, 5, 3, 3 the stand-off is 0: contact", printed == 0, evidence=str(printed))
    watched = stand_off(desired_speed=3, drive=5, weight=5).subs(sp.Symbol("c", positive=True), 6)
    speed = V + (sp.Symbol("v_0", positive=True) - V) * sp.exp(-G * T)
    yield Step(
        "an alien watched up to s = 6, with weights 5 and 5, is kept off by 3 < a = 5, and (w^ga)² > 4w",
        watched == 3 and 5**2 > 4 * 5,
        evidence=str(watched),
    )
    later = speed.subs(sp.exp(-G * T), 1 / (1 + GAP))
    yield Step(
        "if it exerts no force nearer than a > d*, the agent comes nearer than a, where its speed v' = g(v^d - v), "
        "positive at first, stays so, and runs into it",
        sp.simplify(speed.diff(T) - G * (V - speed)) == 0
        and sp.factor(speed.subs(T, 0)).is_positive is True
        and sp.factor(later).is_positive is True,
        r"v = v^d(1 - e^{-gt}) + v_0 e^{-gt} > 0",
        "e^(-gt) <= 1, written as 1/(1 + g₁)",
    )


def _steps() -> Iterator[Step]:
    yield from _push()
    yield from _head_on()


PROOF = Proof(
    id="stand-off",
    title="Errata J9 and J12: what repulsion keeps off, and where it reverses",
    statement=(
        "Let d* = c - v^d w^ga/w (s for c with an alien) be 0 or more. An agent that comes at v^d to the distance c "
        "of a wall or of an alien at rest, with (w^ga)² > 4w, comes ever nearer to d*, and never there; so do two "
        "that meet head on with (w^ga)² > 8w. With the printed weights d* is 0. Inside an obstacle, or beyond a wall, "
        "(8) pushes further in. With (w^ga)² > 4w an alien that exerts no force nearer than a is run into if d* < a."
    ),
    hypotheses=(
        "head on, inputs unbounded, as a differential equation (steps of length δ have the same points of rest); "
        "0 < d < c inside"
    ),
    rigour="symbolic",
    steps=_steps,
    size=10,
    theorems=("J9", "J12"),
)
