"""Averaged headings depend on where angles are counted from: two agents side by side may turn round."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

from flockana.theorems.claims import erratum, exact
from flockana.theorems.theorem import Claim, Tolerances

_AWAY = Fraction(1, 100)  # of a turn: how far two agents head to either side of the direction of angle 0
_TURNS = tuple(Fraction(k, 24) for k in range(24))  # by which the flock is turned


def averaged(headings: tuple[Fraction, ...], zero: Fraction = Fraction(0)) -> Fraction:
    """The mean of headings in turns, each counted in [zero, zero + 1), as a direction in [0, 1).

    Parameters
    ----------
    headings : tuple of Fraction
        In turns.
    zero : Fraction
        Direction from which they are counted.

    Examples
    --------
    >>> averaged((Fraction(1, 8), Fraction(7, 8)))
    Fraction(1, 2)
    >>> averaged((Fraction(1, 8), Fraction(7, 8)), Fraction(1, 2))
    Fraction(0, 1)
    """
    counted = [zero + (heading - zero) % 1 for heading in headings]
    return (sum(counted, start=Fraction(0)) / len(counted)) % 1


def _turned() -> Claim:
    """The mean of a turned pair against the turned mean of the pair, in whole fractions of a turn."""
    pair = (_AWAY, -_AWAY)
    differ = [turn for turn in _TURNS if averaged(tuple((h + turn) % 1 for h in pair)) != turn]
    turned_round = averaged(pair)
    return exact(
        "frame-free",
        not differ,
        computed=str(turned_round),
        stated="turning the whole flock turns the mean headings with it",
        witness={"headings, in turns": [str(_AWAY), str(1 - _AWAY)], "mean": str(turned_round)},
        detail=f"two neighbours at {_AWAY} of a turn to either side of angle 0 both take {turned_round} of a turn: "
        "they turn round; turned by 1/24 or more they go straight on",
    )


def _clear() -> Claim:
    """Headings within a half-turn that does not contain the direction 0: the mean turns with them."""
    steps = [Fraction(k, 24) for k in range(12)]
    pairs = ((a, b, turn) for a, b, turn in product(steps, steps, _TURNS) if 0 <= a + turn < 1 and 0 <= b + turn < 1)
    holds = all(averaged((a + turn, b + turn)) == (a + b) / 2 + turn for a, b, turn in pairs)
    return exact(
        "clear-of-cut",
        holds,
        stated="as long as no heading passes the direction of angle 0, the mean turns with the flock",
        detail="headings in [0, 1) turn: the turned mean is the mean of the turned, on a grid of 24ths",
    )


def _vectors() -> Claim:
    """Vicsek's angle of the mean unit vector, of any pair and turn."""
    import sympy as sp

    a, b, turn = sp.symbols("a b t", real=True)
    mean = sp.exp(sp.I * a) + sp.exp(sp.I * b)
    moved = sp.exp(sp.I * (a + turn)) + sp.exp(sp.I * (b + turn))
    return exact(
        "vectors",
        sp.simplify(sp.expand(moved - sp.exp(sp.I * turn) * mean)) == 0,
        stated="the mean unit vector turns with the flock",
        detail="Σ e^(i(θ + t)) = e^(it) Σ e^(iθ): Vicsek's rule knows no direction of angle 0",
    )


def _check(tolerances: Tolerances) -> list[Claim]:
    return [_turned(), _clear(), _vectors()]


THEOREM = erratum(
    "jlm-cut",
    title="Mean headings depend on where angles are counted from",
    statement=(
        "With headings in [0, 2π) the mean of two that differ little across angle 0 points backwards: the linear rule "
        "is not the same for a turned flock, as a rule of nearest neighbours should be. As long as no heading passes "
        "angle 0 it is; Vicsek's mean of unit vectors always is."
    ),
    source="ours, on Jadbabaie, Lin and Morse's averages of headings in [0, 2π)",
    check=_check,
    references=("jadbabaie-lin-morse-2003", "vicsek-1995"),
    expected={"frame-free": "refuted", "clear-of-cut": "verified", "vectors": "verified"},
)
