"""Derivatives of a function by differences, refused where it has a kink or a jump."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray

_WEIGHTS = (0.75, -0.15, 1.0 / 60.0)  # of f(x + kh) − f(x − kh), k = 1, 2, 3: exact up to the sixth power
ORDER_2 = (0.5,)  # the same for k = 1: exact up to the second power
_WIDEST, _FINEST, _FINER = 1e-3, 1e-7, 4.0
_AGREE = 1e-9  # relative: of two widths; then no finer one is tried
_KINK = 1e-4  # relative: slopes to either side that differ by more than that are those of a kink


class Differences(NamedTuple):
    """Derivative of a function, and the difference of two estimates of it, relative to the largest entry."""

    matrix: FloatArray
    spread: float


def differences(function: Callable[[FloatArray], FloatArray], x: FloatArray, unit: float) -> Differences:
    """Return the derivative ∂f/∂x, shape (f.size, x.size), by central differences of order 6 at the best width.

    Examples
    --------
    >>> found = differences(np.sin, np.array([0.5]), 1.0)
    >>> bool(abs(found.matrix[0, 0] - np.cos(0.5)) < 1e-11), differences(np.abs, np.zeros(1), 1.0).spread
    (True, 1.0)
    """
    width, best_estimate, previous_estimate = _WIDEST, Differences(np.zeros((0, 0)), np.inf), None
    while width >= _FINEST and best_estimate.spread > _AGREE:
        matrix, slope_change = central_differences(function, x, width * unit)
        magnitude = float(np.abs(matrix).max(initial=0.0)) or float(slope_change) or 1.0
        if previous_estimate is not None:
            spread = float(np.abs(matrix - previous_estimate).max(initial=0.0)) / magnitude
            best_estimate = min(best_estimate, Differences(previous_estimate, spread), key=lambda one: one.spread)
        previous_estimate, width = matrix, width / _FINER
    finest_change = central_differences(function, x, _FINEST * unit)[
        1
    ]  # of a kink at x itself central differences know nothing
    magnitude = float(np.abs(best_estimate.matrix).max(initial=0.0))
    relative_change = finest_change / (magnitude or finest_change or 1.0)
    return best_estimate._replace(spread=max(best_estimate.spread, relative_change if relative_change > _KINK else 0.0))


def central_differences(
    function: Callable[[FloatArray], FloatArray], x: FloatArray, h: float, weights: tuple[float, ...] = _WEIGHTS
) -> tuple[FloatArray, float]:
    """Return ∂f/∂x by central differences of one width, and the largest difference of slopes to either side."""
    base_value, columns, bent = function(x).ravel(), [], 0.0
    for k in range(x.size):
        nudge = np.zeros(x.size)
        nudge[k] = h
        steps = [j * nudge.reshape(x.shape) for j in range(1, len(weights) + 1)]
        forward_values, backward_values = ([function(x + s * step).ravel() for step in steps] for s in (1.0, -1.0))
        columns.append(sum(w * (a - b) for w, a, b in zip(weights, forward_values, backward_values, strict=True)) / h)
        bent = max(bent, float(np.abs(forward_values[0] - 2.0 * base_value + backward_values[0]).max(initial=0.0)) / h)
    return np.column_stack(columns) if columns else np.zeros((base_value.size, 0)), bent
