"""Averages over changing nets: a root in every window makes all agree; without one some start never does."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _agree() -> Iterator[Step]:
    low, high, mine, theirs, w = z3.Reals("least most q_i q_j w")
    yield implication(
        "a mean of places between two bounds is between them (checked: of two places, from which all means are made)",
        z3.And(low <= (1 - w) * mine + w * theirs, (1 - w) * mine + w * theirs <= high),
        *(low <= mine, mine <= high, low <= theirs, theirs <= high, w >= 0, w <= 1),
    )
    n = sp.Symbol("n", integer=True, positive=True)
    yield Step(
        "of (n - 1)² windows some agent r is a root of n - 1: were each of n agents one of n - 2 at most, they would "
        "be n(n - 2) = (n - 1)² - 1",
        sp.expand((n - 1) ** 2 - n * (n - 2)) == 1,
        "(n-1)^2 > n(n-2)",
    )
    share, weight, eps, after = z3.Reals("share w eps next")
    yield implication(
        "let S hold the agents in whose place that of r at first has a share >= ε^k after k steps: r at first; who is "
        "in S keeps ε of itself, and who hears one of S takes ε of it. In a window with the root r, while S is not "
        "all, a link leads into S from outside (r is in S and heard by all): one more agent joins",
        after >= eps * share,
        *(share > 0, weight >= eps, eps > 0, after >= weight * share),
    )
    delta, x, y, r, least, most = z3.Reals("delta x y q_r least most")
    yield implication(
        "so after n - 1 of these windows, at most N = (n - 1)²T steps, all have a share δ = ε^N of r, the rest of each "
        "is a mean: places differ by at most (1 - δ) of their extent, and (1 - δ)^k -> 0",
        (delta * r + (1 - delta) * x) - (delta * r + (1 - delta) * y) <= (1 - delta) * (most - least),
        *(delta > 0, delta <= 1, least <= x, x <= most, least <= y, y <= most),
        latex=r"\operatorname{ext} q(k+N) \le (1-\varepsilon^N) \operatorname{ext} q(k)",
    )


def _never() -> Iterator[Step]:
    w, own, other = z3.Reals("w q_i q_j")
    yield implication(
        "without a root two groups never hear anybody outside: begun at 0 and at 1 each stays there, as a mean of "
        "equal places is that place",
        z3.And((1 - w) * own + w * other == own),
        own == other,
    )


def _steps() -> Iterator[Step]:
    yield from _agree()
    yield from _never()


PROOF = Proof(
    id="rooted-averaging",
    title="Averages over changing nets agree where windows have a root",
    statement=(
        "Let q_i become Σ_j w_ij q_j, rows summing to 1. No place leaves the extent of those before. If all w_ii and "
        "all weights that are not 0 are at least ε > 0, and for some T the nets of every T steps together have a "
        "root, all agree from every start; if all nets together have none, some start never agrees."
    ),
    hypotheses="0 < ε <= 1; a finite set of nets has such an ε",
    rigour="smt",
    theorems=("rooted-averaging",),
    steps=_steps,
    size=5,
)
