"""Sums over agents, coordinate by coordinate in four lanes, with equal bits on every processor."""

import numpy as np

from flockana.jit import inlined, kernel, subroutine

_SAMPLE = 256  # agents that suffice to estimate the slope


@inlined
def square_between(q, i, j):
    """Return the squared distance ‖q_j − q_i‖² of two agents."""
    total = 0.0
    for c in range(q.shape[1]):
        gap = q[j, c] - q[i, c]
        total += gap * gap
    return total


@subroutine
def finite(x):
    """Return whether all numbers of an array are finite."""
    is_known = True
    for k in range(x.size):
        is_known &= np.isfinite(x[k])
    return is_known


@subroutine
def column_mean(x, c):
    """Return the mean over agents of coordinate c."""
    n = x.shape[0]
    a = b = d = e = 0.0
    for i in range(0, n - 3, 4):
        a, b, d, e = a + x[i, c], b + x[i + 1, c], d + x[i + 2, c], e + x[i + 3, c]
    for i in range(n // 4 * 4, n):
        a += x[i, c]
    return ((a + b) + (d + e)) / n


@subroutine
def column_squares(x, c, centre):
    """Return the sum of squares Σ_i (x_ic − centre)²."""
    n = x.shape[0]
    a = b = d = e = 0.0
    for i in range(0, n - 3, 4):
        a, b = a + (x[i, c] - centre) ** 2, b + (x[i + 1, c] - centre) ** 2
        d, e = d + (x[i + 2, c] - centre) ** 2, e + (x[i + 3, c] - centre) ** 2
    for i in range(n // 4 * 4, n):
        a += (x[i, c] - centre) ** 2
    return (a + b) + (d + e)


@subroutine
def squared_deviations(x):
    """Return the sum of squared deviations Σ_i ‖x_i − mean‖²."""
    total = 0.0
    for c in range(x.shape[1]):
        total += column_squares(x, c, column_mean(x, c))
    return total


@subroutine
def slope_along(x, y, c, flat):
    """Return the least-squares slope of y_ic over x_ic for a hundred agents; `flat` if undefined."""
    n, stride = x.shape[0], x.shape[0] // _SAMPLE + 1
    centre = squares = products = 0.0
    for i in range(0, n, stride):
        centre += x[i, c]
    centre /= (n + stride - 1) // stride
    for i in range(0, n, stride):
        deviation = x[i, c] - centre
        squares, products = squares + deviation * deviation, products + deviation * (y[i, c] - y[0, c])
    slope = products / squares if squares > 0.0 else flat
    return slope if np.isfinite(slope) else flat


@inlined
def _pull_to(u, x, v, place, velocity, c1, c2, m):
    for c in range(m):
        x_c, v_c = place[c], velocity[c]
        for i in range(x.shape[0]):
            u[i, c] -= c1 * (x[i, c] - x_c) + c2 * (v[i, c] - v_c)


@inlined
def pull_to(u, x, v, place, velocity, c1, c2):
    """Subtract the pull c1 (x − place) + c2 (v − velocity) from the accelerations u."""
    if x.shape[1] == v.shape[1] == u.shape[1] == 2:  # said outright, it lets the compiler take several agents at once
        _pull_to(u, x, v, place, velocity, c1, c2, 2)
    else:
        _pull_to(u, x, v, place, velocity, c1, c2, x.shape[1])


@inlined
def put_row(values, into):
    """Copy a vector to the front of another."""
    for k in range(values.size):
        into[k] = values[k]


@kernel
def put(values, into):
    """Copy an array to the front of another one; both are contiguous.

    numba's own assignment also compiles the text of an error, for a second or two.
    """
    flat_values, target = values.reshape(values.size), into.reshape(into.size)
    for k in range(flat_values.size):
        target[k] = flat_values[k]
