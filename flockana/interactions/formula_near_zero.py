"""Evaluation of a formula's law near 0: direct, by a power series where it cancels, or excluded."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf, isfinite
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.kernels.integral_tables import NODES, series_nodes, series_of

if TYPE_CHECKING:
    from flockana.symbolic.pair_formula import PiecewiseFormula

TERMS = 12  # of the series
_AGREED = 1e-8  # relative: two values of a limit
_LOST = 1e-13  # relative: a formula that loses more is no formula near 0
_EXACT = 3e-16  # relative error of a series, at most
_SOLVED = 40  # digits
_QUARTERS = range(1, 40)
_CLOSE, _CLOSER = 1e-40, 1e-44  # of y at the range: where limits at 0 are read


@dataclass(frozen=True)
class NearZero:
    """Method of evaluating a formula's force weight near distance 0: plain, by power series, or excluded."""

    kind: Literal["plain", "series", "excluded"]
    bound: float = 0.0
    coefficients: FloatArray = field(default_factory=lambda: np.zeros(0))
    panels: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))


def near_zero(cut: PiecewiseFormula, end: float) -> NearZero:
    """Return how to evaluate a formula's force weight near distance 0, from its values in high precision."""
    piece = cut.pieces[0]
    weight, slope = cut.function(piece.weight), cut.function(piece.slope)
    first, second_value = float(weight(end * _CLOSE)), float(weight(end * _CLOSER))
    shares = (float(weight(end * share)) for share in (0.05, 0.25, 0.5))
    scale = max((abs(w) for w in (first, *shares) if isfinite(w)), default=0.0)
    if not (isfinite(first) and isfinite(second_value)) or abs(first - second_value) > _AGREED * max(scale, abs(first)):
        return NearZero("excluded")
    if not _cancels(cut, piece, end, scale):
        return NearZero("plain")
    bends = end * abs(float(slope(end * _CLOSER)) - float(slope(end * _CLOSE)))
    if not bends <= _AGREED * scale:
        return NearZero("plain")  # w has a limit, its slope has none: the formula from a tiny s on
    for k in _QUARTERS:
        bound = min(end, cut.marks[1] if cut.marks[1] < cut.end else end) * 0.25**k
        coefficients, error = _series(weight, bound)
        if error <= _EXACT * scale:
            return NearZero("series", bound, coefficients, _energy_panel(cut, bound))
    raise ArgumentError("the formula has no series at s = 0 that converges: expected one that is smooth there")


def _cancels(cut: PiecewiseFormula, piece: Any, end: float, scale: float) -> bool:
    """Return whether floating point loses digits of the formula near 0, or has no value there."""
    import sympy as sp

    from flockana.symbolic import pair_formula as pf

    y = pf.Z if cut.formula.distance == pf.Z else pf.SQUARE
    symbols = list(cut.numbers)
    parts = [(piece.weight, scale), (piece.slope, scale / end)]
    if piece.potential is not None:
        parts.append((piece.potential, scale * end))
    for part, size in parts:
        plain = sp.lambdify(
            [y, *symbols], part.subs(pf.ROOT, sp.sqrt(1 + pf.EPS * (2 * pf.Z + pf.EPS * pf.Z**2))), "math", dummify=True
        )
        exact = cut.function(part)
        for share in (0.0, *(0.25**j for j in range(2, 60))):
            true = float(exact(max(end * share, end * _CLOSER)))
            try:
                limit = float(plain(end * share, *cut.numbers.values()))
            except (ZeroDivisionError, ValueError, OverflowError, TypeError):
                return True
            if not abs(limit - true) <= _LOST * max(abs(true), size):
                return True
    return False


def _series(function: Any, bound: float) -> tuple[FloatArray, float]:
    """Return coefficients of the weight's power series in y/bound on [0, bound], and its largest error."""
    import mpmath  # type: ignore[import-untyped]
    from numpy.polynomial import chebyshev

    with mpmath.workdps(_SOLVED):
        nodes = [mpmath.mpf(x) for x in 0.5 * (1.0 + chebyshev.chebpts1(TERMS))]
        power_matrix = mpmath.matrix([[x**k for k in range(TERMS)] for x in nodes])
        coefficients = mpmath.lu_solve(power_matrix, mpmath.matrix([function(bound * x) for x in nodes]))
        powers = np.array([float(x) for x in coefficients])
    sample_shares = np.linspace(0.0, 1.0, 23)[1:]
    exact = np.array([float(function(bound * x)) for x in sample_shares])
    error = float(np.abs(np.polynomial.polynomial.polyval(sample_shares, powers) - exact).max())
    return powers, error if isfinite(error) else inf


def _energy_panel(cut: PiecewiseFormula, bound: float) -> FloatArray:
    """Return the potential on [0, bound] as a Chebyshev panel; empty where the force was given."""
    from numpy.polynomial import chebyshev

    potential = cut.pieces[0].potential
    if potential is None:
        return np.zeros((0, 0))
    exact = cut.function(potential)
    values = np.array([float(exact(0.5 * bound * (1.0 + x))) for x in series_nodes()])
    panel = np.zeros((1, 3 + NODES))
    powers = chebyshev.cheb2poly(series_of(values)[:12])
    panel[0, :2], panel[0, 2 : 2 + powers.size] = (0.0, bound), powers
    return panel
