"""Agents sorted into the cells of a grid: those within a range of each other are in the same or in adjacent cells."""

from __future__ import annotations

import numpy as np

from flockana.jit import kernel

_MARGIN = 1.0 + 1e-6  # cells a little larger than the range, so that rounding never separates two that are within it
_PER_AGENT, _AT_LEAST = 8.0, 256.0  # cells at most: a sparser box is left to the search by hashed cells


@kernel
def sort_into_grid(q, side):
    """(order, start, rows): agents by cell, first agent of each cell, and where the later adjacent rows of cells are.

    Cells are numbered row by row, with an empty margin around. What is adjacent to cell c, each two cells once, is the
    rest of c, cell c + 1, and of each row d in `rows` the cells c + d − 1 to c + d + 1. `start` is empty where the box
    is so sparse that cells would be many more than agents.
    """
    n, m = q.shape
    low, strides, total = np.empty(m), np.empty(m + 1, np.int64), 1.0
    strides[0] = 1
    for k in range(m):
        lowest = highest = q[0, k]
        for i in range(n):
            lowest, highest = min(lowest, q[i, k]), max(highest, q[i, k])
        low[k] = lowest
        across = np.floor((highest - lowest) / (side * _MARGIN)) + 3.0
        total *= across
        if not total <= max(_PER_AGENT * n, _AT_LEAST):
            return np.empty(0, np.uint64), np.empty(0, np.uint64), np.empty(0, np.uint64)
        strides[k + 1] = strides[k] * np.int64(across)
    start, cell = np.zeros(strides[m] + 1, np.uint64), np.empty(n, np.int64)
    for i in range(n):
        c = 0
        for k in range(m):
            place = (q[i, k] - low[k]) / (side * _MARGIN)
            c += strides[k] * (1 + (np.int64(place) if place > 0.0 else 0))  # NaN too, which is within no range
        cell[i] = c
        start[c + 1] += np.uint64(1)
    for c in range(strides[m]):
        start[c + 1] += start[c]
    fill, order = start[:-1].copy(), np.empty(n, np.uint64)
    for i in range(n):
        order[fill[cell[i]]] = i
        fill[cell[i]] += np.uint64(1)
    rows = np.empty((0, 1, 4)[m - 1], np.uint64)
    if m == 2:
        rows[0] = strides[1]
    if m == 3:
        rows[0], rows[1] = strides[1], strides[2] - strides[1]
        rows[2], rows[3] = strides[2], strides[2] + strides[1]
    return order, start, rows
