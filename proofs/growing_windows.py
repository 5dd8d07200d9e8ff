"""Three agents that average in halves, in rounds that grow: every round has a root, and they never agree."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _steps() -> Iterator[Step]:
    a, half = z3.Reals("gap h")  # h = 2^-L
    x, y, end, moved = z3.Reals("q_0 q_1 q_2 moved")
    k = sp.Symbol("k", integer=True, positive=True)
    yield Step(
        "while 1 hears 0 their distance halves in each step: after L steps it is 2^-L of what it was",
        sp.simplify(sp.Rational(1, 2) ** (k + 1) - sp.Rational(1, 2) ** k / 2) == 0,
        "2^{-L}",
    )
    yield implication(
        "0 then moves to the middle of the two, so by at most 2^-(L+1) of the distance s of 0 and 2, as 1 is between; "
        "then 1 and 2 do the same: a round keeps 1 - 2^-L of s",
        end - moved >= (1 - half / 2) * (end - x),
        *(a == y - x, x <= y, y <= end, half >= 0, half <= 1, moved == x + half * a / 2),
    )
    one, two = z3.Reals("kept h2")
    yield implication(
        "of two shares in a row, (1 - h/2)(1 - h/2) >= 1 - h; and of shares 1 - h the product is at least 1 - Σ h",
        z3.And((1 - half / 2) * (1 - half / 2) >= 1 - half, one * (1 - two) >= one - two),
        *(half >= 0, two >= 0, one <= 1),
    )
    first = sp.Symbol("L", integer=True, positive=True)
    yield Step(
        "with L, L + 1, ... (or longer ones) Σ 2^-L is at most 2^(1-L), below 1 for L >= 2",
        sp.simplify(sp.summation(2 ** (-first - k + 1), (k, 1, sp.oo)) - 2 ** (1 - first)) == 0,
        r"\sum_{k\ge L} 2^{-k} = 2^{1-L}",
    )


PROOF = Proof(
    id="growing-windows",
    title="Averages that never agree, though every round has a root",
    statement=(
        "Let agent 1, between 0 and 2 on a line, average in halves with 0 for L steps, then 0 with 1 for one, 1 with 2 "
        "for L, 2 with 1 for one, L >= 2 rising by one or more from round to round: the distance of 0 and 2 stays "
        "above 1 - 2^(1-L) of the first."
    ),
    hypotheses="agent 1 begins between the others, which differ",
    rigour="smt",
    theorems=("growing-windows",),
    steps=_steps,
    size=4,
)
