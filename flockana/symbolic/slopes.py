"""Bounds of a pair law's slopes on parts of its range."""

from itertools import pairwise
from math import inf
from typing import NamedTuple

import sympy as sp
from flint import arb, fmpq

from flockana.symbolic.decide import up
from flockana.symbolic.enclosed import Enclosed, interval, precision
from flockana.symbolic.pair_facts import exact_numbers
from flockana.symbolic.pair_formula import EPS, PiecewiseFormula, S, Z

_HALVINGS = 6  # of a part, for a bound within twice the slope at its middle
_BITS = 96


class SlopeBound(NamedTuple):
    """Bounds of |dF/ds| and |da/ds| between two distances; infinite where unknown."""

    left: float
    right: float
    force: float
    adjacency: float


def slope_bounds(
    cut: PiecewiseFormula, eps: float, r: float, places: list[float], parts: int
) -> tuple[SlopeBound, ...]:
    """Return bounds of the slopes on equal parts of the range, also split at the cuts."""
    numbers, found = exact_numbers(cut.numbers, eps), []
    root = sp.sqrt(1 + EPS * S**2)
    norm, along = ((root - 1) / EPS, S / root) if eps else (S, sp.Integer(1))
    edges = sorted({r * k / parts for k in range(parts)} | {*places, r})
    for left, right in pairwise(edges):
        middle = 0.5 * (left + right)
        at = middle * middle / ((1.0 + eps * middle * middle) ** 0.5 + 1.0) if eps else middle
        main, weight = (cut.chosen(each, at).subs(Z, norm) for each in (cut.formula.main, cut.formula.adjacency))
        force, order = (main * along, 1) if cut.formula.forces else (main, 2)
        rows = (Enclosed(force.xreplace(numbers), S), order), (Enclosed(weight.xreplace(numbers), S), 1)
        ends = fmpq(*left.as_integer_ratio()), fmpq(*right.as_integer_ratio())
        found.append(SlopeBound(left, right, *(order * _most(of, order, *ends, 0) for of, order in rows)))
    return tuple(found)


def _most(of: Enclosed, order: int, left: fmpq, right: fmpq, depth: int) -> float:
    """Return a bound of a Taylor coefficient on an interval."""
    middle = (left + right) / 2
    with precision(_BITS, order + 1):
        found, at = of.series(interval(left, right)), of.series(arb(middle))
        if found is not None and at is not None and found[order].abs_upper() <= 2 * at[order].abs_upper():
            return up(found[order].abs_upper())
    if depth >= _HALVINGS:
        return inf if found is None else up(found[order].abs_upper())
    return max(_most(of, order, *ends, depth + 1) for ends in ((left, middle), (middle, right)))
