"""Derivatives of a function by differences, refused where it has a kink or a jump."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from flockana.base.checks import FloatArray

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
    width, best, before = _WIDEST, Differences(np.zeros((0, 0)), np.inf), None
    while width >= _FINEST and best.spread > _AGREE:
        matrix, bent = central_differences(function, x, width * unit)
        size = float(np.abs(matrix).max(initial=0.0)) or float(bent) or 1.0
        if before is not None:
            spread = float(np.abs(matrix - before).max(initial=0.0)) / size
            best = min(best, Differences(before, spread), key=lambda one: one.spread)
        before, width = matrix, width / _FINER
    ahead = central_differences(function, x, _FINEST * unit)[
        1
    ]  # of a kink at x itself central differences know nothing
    size = float(np.abs(best.matrix).max(initial=0.0))
    kink = ahead / (size or ahead or 1.0)
    return best._replace(spread=max(best.spread, kink if kink > _KINK else 0.0))


def central_differences(
    function: Callable[[FloatArray], FloatArray], x: FloatArray, h: float, weights: tuple[float, ...] = _WEIGHTS
) -> tuple[FloatArray, float]:
    """Return ∂f/∂x by central differences of one width, and the largest difference of slopes to either side."""
    here, columns, bent = function(x).ravel(), [], 0.0
    for k in range(x.size):
        nudge = np.zeros(x.size)
        nudge[k] = h
        steps = [j * nudge.reshape(x.shape) for j in range(1, len(weights) + 1)]
        ahead, behind = ([function(x + s * step).ravel() for step in steps] for s in (1.0, -1.0))
        columns.append(sum(w * (a - b) for w, a, b in zip(weights, ahead, behind, strict=True)) / h)
        bent = max(bent, float(np.abs(ahead[0] - 2.0 * here + behind[0]).max(initial=0.0)) / h)
    return np.column_stack(columns) if columns else np.zeros((here.size, 0)), bent
