"""A safety filter by barrier functions: barriers stay above 0, braking meets them, and when it is too late."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _motion() -> Iterator[Step]:
    t, c, least = sp.symbols("t c D", positive=True)
    x, y = (sp.Function(name)(t) for name in "xy")
    r = sp.sqrt(x**2 + y**2)
    speed, pull = sp.diff(r, t), (x * sp.diff(x, t, 2) + y * sp.diff(y, t, 2)) / r
    turn = (sp.diff(x, t) ** 2 + sp.diff(y, t) ** 2 - speed**2) / r
    root = sp.sqrt(2 * c * (r - least))
    yield Step(
        "with s = √(2c(r - D)) and the unit vector e of the pair h' = c r'/s + (‖v‖² - r'²)/r + e·(u_i - u_j) "
        "(checked: in the plane)",
        sp.simplify(sp.diff(root + speed, t) - c * speed / root - turn - pull) == 0,
        r"\dot h = c\dot r/s + (\|v\|^2 - \dot r^2)/r + e\cdot(u_i - u_j)",
    )
    gain, start = sp.symbols("gamma h_0", positive=True)
    bound = 1 / sp.sqrt(start**-2 + 2 * gain * t)
    yield Step(
        "h' >= -γh³ from h_0 > 0 keeps h >= 1/√(1/h_0² + 2γt) > 0, the solution of h' = -γh³ (comparison)",
        sp.simplify(sp.diff(bound, t) + gain * bound**3) == 0 and sp.simplify(bound.subs(t, 0) - start) == 0,
        r"h \ge (h_0^{-2} + 2\gamma t)^{-1/2}",
    )


def _steps() -> Iterator[Step]:
    yield from _motion()
    s, w, c, r, least = z3.Reals("s w c r D")
    yield implication(
        "so where r nears D, s nears 0 and r' = h - s is positive: r = D is not reached",
        w > 0,
        *(s >= 0, s < c, s + w >= c),
    )
    ask, cube, share, turn = z3.Reals("ask gh3 h_over_s turn")
    yield implication(
        "where h >= 0, c r'/s = c(h/s - 1), and what is asked of e·(u_i - u_j) is at most c = 2α: both brake with α",
        ask <= c,
        *(c > 0, cube >= 0, share >= 0, turn >= 0, ask == -cube - c * (share - 1) - turn),
    )
    k, d = z3.Reals("k r")
    yield implication(
        "inputs u_i = k q_i have e·(u_i - u_j) = k r: for a large k they meet the conditions of all pairs together, so "
        "that the filter always has an answer",
        k * d >= ask,
        *(d >= least, least > 0, k * least >= ask, k >= 0),
    )
    yield implication(
        "on a line r'' <= c: after the time -r'/c the distance is at most r - r'²/(2c), below D where h < 0",
        r - least < w * w / (2 * c),
        *(c > 0, s >= 0, s * s == 2 * c * (r - least), s + w < 0),
    )


PROOF = Proof(
    id="safety-filter",
    title="A safety filter by barrier functions of pairs",
    statement=(
        "Let h = √(2c(r - D)) + r', c = 2α, and h' >= -γh³ for each pair. Pairs that start with r > D and h > 0 keep "
        "both; where h >= 0 two agents that brake with α meet the condition; on a line, where h < 0, no inputs up to α "
        "keep D."
    ),
    hypotheses="c, D, γ > 0; a solution of the law",
    rigour="smt",
    theorems=("safety-filter",),
    steps=_steps,
    size=6,
)
