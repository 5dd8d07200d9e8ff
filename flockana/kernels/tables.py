"""Panels of polynomials for an integral that has no closed form: built once, to rounding; `on_panels` evaluates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev, polynomial  # noqa: F401  # the doctest's

FloatArray = npt.NDArray[np.float64]

NODES = 24  # with panels no wider than half their distance to a pole the series falls below 1e-15 before this


def panel_edges(left: float, right: float, centre: float) -> FloatArray:
    """Panel boundaries on [left, right] for a function with poles at centre ± i (those of σ₁).

    Each panel is about as wide as its distance from the poles, so their number grows with the logarithm of the
    interval only.

    Parameters
    ----------
    left, right : float
        The interval.
    centre : float
        Real part of the poles.

    Examples
    --------
    >>> panel_edges(0.0, 4.0, 1.0).tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0]
    """
    steps = 2.0 ** np.arange(max(1, int(np.ceil(np.log2(1.0 + abs(left - centre) + abs(right - centre)))) + 1))
    marks = np.concatenate([centre - steps, [centre], centre + steps])
    return np.concatenate([[left], np.sort(marks[(marks > left) & (marks < right)]), [right]])


def integral_panels(
    function: Callable[[FloatArray], FloatArray], edges: FloatArray, *, anchor: float, value: float = 0.0
) -> FloatArray:
    """Panels of the antiderivative of `function` that equals `value` at the edge `anchor`.

    It is summed from there to both sides: what rounds far away, where the integral may be large, stays there.

    Parameters
    ----------
    function : callable
        Analytic within each panel; takes and returns a one-dimensional array.
    edges : ndarray, shape (K + 1,)
        Rising panel boundaries.
    anchor : float
        One of the edges.
    value : float
        Value of the antiderivative there.

    Returns
    -------
    ndarray, shape (K, 3 + NODES)
        A row per panel: left end, right end, coefficients of the powers of x, which is −1 and 1 there. The series falls
        faster than those powers' Chebyshev coefficients grow, so that nothing is lost by them.

    Examples
    --------
    >>> panels = integral_panels(lambda z: 2.0 * z, np.array([0.0, 1.0, 3.0]), anchor=3.0, value=9.0)
    >>> bool(abs(polynomial.polyval(-1.0, panels[0, 2:])) < 1e-14)  # z² at 0
    True
    """
    nodes = chebyshev.chebpts1(NODES)
    panels = np.zeros((edges.size - 1, 3 + NODES))
    first = int(np.searchsorted(edges, anchor))
    for rows, start in ((range(first - 1, -1, -1), 1.0), (range(first, edges.size - 1), -1.0)):
        reached = value
        for k in rows:
            left, right = edges[k], edges[k + 1]
            half = 0.5 * (right - left)
            series = chebyshev.chebfit(nodes, function(0.5 * (left + right) + half * nodes), NODES - 1)
            integral = half * chebyshev.chebint(series)
            integral[0] += reached - chebyshev.chebval(start, integral)
            powers = chebyshev.cheb2poly(integral)  # without the zeros at its end
            panels[k, 0], panels[k, 1], panels[k, 2 : 2 + powers.size] = left, right, powers
            reached = float(chebyshev.chebval(-start, integral))
    return panels
