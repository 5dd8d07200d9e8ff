"""Sums over agents in twelve lanes: as fast as a processor adds, and the same to the bit on every one.

Twelve is a multiple of every dimension, so a lane is of one coordinate.
"""

from __future__ import annotations

import numpy as np

from flockana.kernels.compiling import njit

LANES = 12


@njit(cache=True, error_model="numpy", nogil=True)
def repeated(row):
    """A row over and over, a number for each lane."""
    lanes = np.empty(LANES)
    for k in range(LANES):
        lanes[k] = row[k % row.size]
    return lanes


@njit(cache=True, error_model="numpy", nogil=True)
def column_means(x):
    """The mean over agents, shape (m,)."""
    n, m = x.shape
    a, lanes, means, whole = x.reshape(n * m), np.zeros(LANES), np.zeros(m), n * m // LANES * LANES
    for begin in range(0, whole, LANES):
        for k in range(LANES):
            lanes[k] += a[begin + k]
    for k in range(whole, n * m):
        lanes[k - whole] += a[k]
    for k in range(LANES):
        means[k % m] += lanes[k] / n
    return means


@njit(cache=True, error_model="numpy", nogil=True)
def squared_differences(x, row):
    """Σ_i ‖x_i − row‖²."""
    n, m = x.shape
    a, lanes, wide, whole = x.reshape(n * m), np.zeros(LANES), repeated(row), n * m // LANES * LANES
    for begin in range(0, whole, LANES):
        for k in range(LANES):
            lanes[k] += (a[begin + k] - wide[k]) ** 2
    for k in range(whole, n * m):
        lanes[k - whole] += (a[k] - wide[k - whole]) ** 2
    total = 0.0
    for k in range(LANES):
        total += lanes[k]
    return total


@njit(cache=True, error_model="numpy", nogil=True)
def pull_to(u, x, v, place, velocity, c1, c2):
    """u −= c1 (x − place) + c2 (v − velocity)."""
    n, m = x.shape
    a, b, out, whole = x.reshape(n * m), v.reshape(n * m), u.reshape(n * m), n * m // LANES * LANES
    p, q = repeated(place), repeated(velocity)
    for begin in range(0, whole, LANES):
        for k in range(LANES):
            out[begin + k] -= c1 * (a[begin + k] - p[k]) + c2 * (b[begin + k] - q[k])
    for k in range(whole, n * m):
        out[k] -= c1 * (a[k] - p[k - whole]) + c2 * (b[k] - q[k - whole])
