"""Fast norms and means of many short vectors, where numpy reduces slowly."""

from math import frexp, ldexp

import numpy as np

from flockana.base.value_checks import FloatArray

_SQUARED = 2.0**-400, 2.0**400  # between which the largest number may be squared, and be small against it what is lost


def lengths(x: FloatArray) -> FloatArray:
    """Return Euclidean norms along the last axis, equal to `numpy.linalg.norm` bit by bit but faster."""
    squares = x[..., 0] ** 2
    for k in range(1, x.shape[-1]):
        squares += x[..., k] ** 2
    return np.sqrt(squares, out=squares)


def centres(x: FloatArray) -> FloatArray:
    """Return the means over agents at each instant, (T, n, m) -> (T, m), equal to ``x.mean(axis=1)`` bit by bit."""
    if x.shape[2] == 1:  # numpy's sums of what lies side by side are fast, and are summed in pairs
        return x.mean(axis=1)
    return np.ascontiguousarray(x.swapaxes(0, 1)).mean(axis=0)


def scaled_near_one(x: FloatArray, *others: float) -> tuple[FloatArray, tuple[float, ...], float]:
    """Return numbers divided by a power of two, and that power: 1 unless squares would overflow or underflow."""
    top = max(float(x.max(initial=0.0)), -float(x.min(initial=0.0)), *others)
    if _SQUARED[0] < top < _SQUARED[1] or not 0.0 < top < np.inf:
        return x, others, 1.0
    unit = ldexp(1.0, frexp(top)[1] - 1)
    return x / unit, tuple(other / unit for other in others), unit
