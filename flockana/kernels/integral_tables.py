"""Polynomial panels of an integral without closed form: built once to rounding, evaluated by kernels.

What leads from values to coefficients is the same for every panel: three matrices, whose products are summed here. The
solvers of linear algebra, which sum otherwise on other processors, have no part in it.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev, polynomial  # noqa: F401  # the doctest's

from flockana.jit import register_jitable

FloatArray = npt.NDArray[np.float64]

NODES = 24  # with panels no wider than half their distance to a pole the series falls below 1e-15 before this


def panel_edges(left: float, right: float, centre: float) -> FloatArray:
    """Return panel boundaries on [left, right] for a function with poles at centre ± i (those of σ₁).

    Each panel is about as wide as its distance from the poles, so their number grows with the logarithm of the
    interval only.
    """
    steps = 2.0 ** np.arange(max(1, int(np.ceil(np.log2(1.0 + abs(left - centre) + abs(right - centre)))) + 1))
    marks = np.concatenate([centre - steps, [centre], centre + steps])
    return np.concatenate([[left], np.sort(marks[(marks > left) & (marks < right)]), [right]])


def integral_panels(
    function: Callable[[FloatArray], FloatArray], edges: FloatArray, *, anchor: float, value: float = 0.0
) -> FloatArray:
    """Return panels of the antiderivative of `function` that equals `value` at the edge `anchor`.

    It is summed from there to both sides: what rounds far away, where the integral may be large, stays there.
    """
    half, midpoints = 0.5 * np.diff(edges)[:, None], 0.5 * (edges[:-1] + edges[1:])[:, None]
    values = function((midpoints + half * series_nodes()).ravel()).reshape(-1, NODES)
    integrals: FloatArray = half * _times(series_of(values), _integration())
    at_left, at_right = integrals[:, ::2].sum(axis=1) - integrals[:, 1::2].sum(axis=1), integrals.sum(axis=1)
    first, last = int(np.searchsorted(edges, anchor)), edges.size - 1
    for rows, start, end in ((range(first - 1, -1, -1), at_right, at_left), (range(first, last), at_left, at_right)):
        total = value
        for k in rows:
            rise = total - start[k]
            integrals[k, 0] += rise
            total = end[k] + rise
    return np.hstack([edges[:-1, None], edges[1:, None], _times(integrals, _powers())])


def series_nodes() -> FloatArray:
    """Return the points of [−1, 1] at which `series_of` needs a function: the zeros of T_N, shape (NODES,)."""
    return _cosines()[:, 1]


def series_of(values: FloatArray) -> FloatArray:
    """Return the coefficients of functions on [−1, 1] by Chebyshev polynomials."""
    return _times(values, _orthogonality())


def _times(rows: FloatArray, matrix: FloatArray) -> FloatArray:
    """Return rows times a matrix, summed in the same order on every processor."""
    product: FloatArray = (rows[..., :, None] * matrix).sum(axis=-2)
    return product


@cache
def _cosines() -> FloatArray:
    """Return T_j(x_k) = cos πj(2k + 1)/2N, shape (N, N), each from the first quadrant for accuracy."""
    quadrant = np.append(np.cos(0.5 * np.pi / NODES * np.arange(NODES)), 0.0)
    turns = np.outer(2 * np.arange(NODES) + 1, np.arange(NODES)) % (4 * NODES)  # a quadrant has N steps
    turns = np.minimum(turns, 4 * NODES - turns)
    cosines: FloatArray = np.where(turns > NODES, -1.0, 1.0) * quadrant[NODES - np.abs(NODES - turns)]
    cosines.setflags(write=False)  # handed out, and kept
    return cosines


@cache
def _orthogonality() -> FloatArray:
    """Return the matrix from values to a series: c_j = 2/N Σ_k f(x_k) T_j(x_k), of c₀ the half."""
    matrix = _cosines() * (2.0 / NODES)
    matrix[:, 0] *= 0.5
    return matrix


@cache
def _integration() -> FloatArray:
    """Return the matrix from a series to the series of its integral from 0."""
    return np.asarray(chebyshev.chebint(np.eye(NODES)).T, dtype=np.float64)


@cache
def _powers() -> FloatArray:
    """Return the integer matrix from Chebyshev coefficients to coefficients of powers."""
    matrix = np.zeros((NODES + 1, NODES + 1))
    for j, series in enumerate(np.eye(NODES + 1)):
        powers = chebyshev.cheb2poly(series)
        matrix[j, : powers.size] = powers
    return matrix


@register_jitable
def on_panels(z, panels):
    """Return the value at z of a function given by panels of polynomials, rows (left, right, coefficients) that rise.

    A coefficient is that of a power of x, which is −1 at the left end and 1 at the right one; they are one more than a
    multiple of four, whose four sums need not wait for each other.
    Points outside take the value at the nearest end. No branch hangs on z: a loop over it runs ahead of itself.
    """
    row, panel_count = 0, panels.shape[0]
    while panel_count > 1:
        half_count = panel_count // 2
        row += half_count * (z >= panels[row + half_count - 1, 1])
        panel_count -= half_count
    left, right = panels[row, 0], panels[row, 1]
    x = (2.0 * z - left - right) / (right - left)
    if abs(x) > 1.0:  # not by min and max, which would turn a NaN into a number
        x = 1.0 if x > 0.0 else -1.0
    last_index = panels.shape[1] - 1
    a, b, c, d, x2 = panels[row, last_index], 0.0, 0.0, 0.0, x * x
    x4 = x2 * x2
    for k in range(last_index - 4, 1, -4):
        a, b = x4 * a + panels[row, k], x4 * b + panels[row, k + 1]
        c, d = x4 * c + panels[row, k + 2], x4 * d + panels[row, k + 3]
    return (a + x2 * c) + x * (b + x2 * d)
