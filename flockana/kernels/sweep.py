"""Forces of all pairs within range in one compiled call.

Agents are sorted by cell. Candidates are gathered into blocks, those within range kept without a branch; the pair law
runs over a block in a loop that the compiler turns into vector instructions, if the law has no branches of its own;
and what it gives is added to both agents. One dimension, one loop: m is a constant of the compiled code.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.grid import sort_into_grid

BLOCK = 512  # pairs: what is known of them stays in the first-level cache


def lift_block(pair: Callable[..., Any], m: int) -> Callable[..., Any]:
    """What a block of pairs adds to u, from their differences d and squared distances s2; returns Σ a ‖p_j − p_i‖².

    w and a are room for what the law gives; `par` is a tuple: constants in registers, which no array can alias.
    """

    @register_jitable
    def add(count, first, second, d, s2, w, a, v, u, par, c1, c2):
        for k in range(count):
            w[k], a[k] = pair(s2[k], par)
        total = 0.0
        for k in range(count):
            i, j = first[k], second[k]
            v2 = 0.0
            for c in range(m):
                slip = v[j, c] - v[i, c]
                v2 += slip * slip
                f = c1 * w[k] * d[c, k] + c2 * a[k] * slip
                u[i, c] += f
                u[j, c] -= f
            total += a[k] * v2
        return total

    return add


def lift_sweep(pair: Callable[..., Any], m: int, digest: int) -> tuple[Callable[..., Any], Callable[..., float]]:
    """Compile the sums of a pair law in m dimensions: over all pairs within a range, and over the pairs given.

    The first, ``forces(q, p, r, par, c1, c2, u)``, adds c1 w (q_j − q_i) + c2 a (p_j − p_i) to u_i, its opposite to
    u_j, and returns (True, Σ a ‖p_j − p_i‖²), or (False, 0) and adds nothing where the flock is too sparse for a grid;
    the second, ``forces_of(q, p, i, j, par, c1, c2, u)``, does so for pairs that are within range and returns the sum.
    ``par`` is a tuple.
    """
    add = lift_block(pair, m)

    @njit(cache=True, error_model="numpy")
    def forces(q, p, r, par, c1, c2, u):
        total = 0.0 * digest
        order, start, rows = sort_into_grid(q, r)
        if start.size == 0:
            return False, 0.0
        x, v, forced, r2 = q[order], p[order], np.zeros(q.shape), max(r * r, 5e-324)
        first, second = np.empty(BLOCK, np.uint64), np.empty(BLOCK, np.uint64)
        d, s2, w, a = np.empty((m, BLOCK)), np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
        count = 0
        for cell in range(start.size - 2):
            for i in range(start[cell], start[cell + 1]):
                for row in range(-1, np.int64(rows.size)):
                    begin, end = i + np.uint64(1), start[cell + 2]
                    if row >= 0:
                        there = np.int64(cell) + np.int64(rows[row])
                        begin, end = start[there - 1], start[there + 2]
                    for j in range(begin, end):
                        square = 0.0
                        for c in range(m):
                            gap = x[j, c] - x[i, c]
                            d[c, count] = gap
                            square += gap * gap
                        s2[count], first[count], second[count] = square, i, j
                        count += square < r2
                        if count == BLOCK:
                            total += add(count, first, second, d, s2, w, a, v, forced, par, c1, c2)
                            count = 0
        total += add(count, first, second, d, s2, w, a, v, forced, par, c1, c2)
        for k in range(order.size):
            for c in range(m):
                u[order[k], c] += forced[k, c]
        return True, total

    @njit(cache=True, error_model="numpy")
    def forces_of(q, p, first, second, par, c1, c2, u):
        total = 0.0 * digest
        d, s2, w, a = np.empty((m, BLOCK)), np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
        for begin in range(0, first.size, BLOCK):
            i, j = first[begin : begin + BLOCK], second[begin : begin + BLOCK]
            for k in range(i.size):
                s2[k] = 0.0
                for c in range(m):
                    gap = q[j[k], c] - q[i[k], c]
                    d[c, k] = gap
                    s2[k] += gap * gap
            total += add(i.size, i, j, d, s2, w, a, p, u, par, c1, c2)
        return total

    return forces, forces_of
