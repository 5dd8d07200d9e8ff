"""Forces of all pairs within range in one compiled call.

Agents are sorted by cell. Candidates are gathered into blocks, those within range kept without a branch; the pair law
runs over a block in a loop that the compiler turns into vector instructions, if the law has no branches of its own;
and what it gives is added to both agents. One dimension, one loop: m is a constant of the compiled code.
The compiler may not fuse products and sums, though it would save a fourteenth: every processor gives the same bits.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.grid import sort_into_grid

BLOCK = 512  # pairs: what is known of them stays in the first-level cache


# The differences of two rows at once: all is read before anything is written, which might be the same place.
@register_jitable
def _apart1(x, i, j):
    return (x[j, 0] - x[i, 0],)


@register_jitable
def _apart2(x, i, j):
    return x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]


@register_jitable
def _apart3(x, i, j):
    return x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]


_APART = {1: _apart1, 2: _apart2, 3: _apart3}


def _at_once(pair: Callable[..., Any]) -> Callable[..., None]:
    """The law of a block of pairs, w and a, from their squared distances."""

    @register_jitable
    def law(count, s2, w, a, par, c1):
        for k in range(count):
            stress, adjacency = pair(s2[k], par)
            w[k], a[k] = c1 * stress, adjacency

    return law


def _by_norm(pair: Callable[..., Any], norm: Callable[..., Any]) -> Callable[..., None]:
    """The same where a law begins with a norm.

    Roots and divisions wait for each other, and a processor looks only some hundred instructions ahead: two short loops
    keep its dividing unit busier than one long one.
    """

    @register_jitable
    def law(count, s2, w, a, par, c1):
        for k in range(count):
            w[k], a[k] = norm(s2[k], par)
        for k in range(count):
            stress, adjacency = pair(w[k], a[k], par)
            w[k], a[k] = c1 * stress, adjacency

    return law


def lift_block(pair: Callable[..., Any], m: int, norm: Callable[..., Any] | None) -> Callable[..., Any]:
    """What a block of pairs adds to u, from their squared distances s2; returns Σ a ‖p_j − p_i‖².

    w and a are room for what the law gives; `par` is a tuple: constants in registers, which no array can alias.
    """
    law, apart = _at_once(pair) if norm is None else _by_norm(pair, norm), _APART[m]

    @register_jitable
    def add(count, first, second, s2, w, a, x, v, u, par, c1, c2):
        if not (x.shape[1] == m and v.shape[1] == m and u.shape[1] == m):
            return np.nan  # never: the compiler now knows that rows are m numbers apart
        law(count, s2, w, a, par, c1)
        total = 0.0
        for k in range(count):
            i, j, weight, drag = first[k], second[k], w[k], c2 * a[k]
            gap, slip, v2 = apart(x, i, j), apart(v, i, j), 0.0
            for c in range(m):
                v2 += slip[c] * slip[c]
            total += a[k] * v2
            for c in range(m):
                u[i, c] += weight * gap[c] + drag * slip[c]
            for c in range(m):
                u[j, c] -= weight * gap[c] + drag * slip[c]
        return total

    return add


def lift_sweep(
    pair: Callable[..., Any], m: int, norm: Callable[..., Any] | None, digest: int
) -> tuple[Callable[..., Any], Callable[..., float]]:
    """Compile the sums of a pair law in m dimensions: over all pairs within a range, and over the pairs given.

    The first, ``forces(q, p, r, par, c1, c2, u, room)``, adds c1 w (q_j − q_i) + c2 a (p_j − p_i) to u_i, its opposite
    to u_j, and returns (True, Σ a ‖p_j − p_i‖²), or (False, 0) and adds nothing where the flock is too sparse for a
    grid; `room`, (3, n, m), is for the flock sorted by cell. It is numpy's, which asks for large pages where numba does
    not: small ones take a third of the time of a million agents. The second, ``forces_of(q, p, i, j, par, c1, c2, u)``,
    does so for pairs that are within range and returns the sum.
    ``par`` is a tuple.
    """
    add = lift_block(pair, m, norm)

    @njit(error_model="numpy", _nrt=False)
    def sweep(start, rows, x, v, forced, r2, par, c1, c2, near, room):
        first, second, s2, w, a = near[0], near[1], room[0], room[1], room[2]
        count, total = 0, 0.0 * digest
        if x.shape[1] != m:
            return np.nan  # as above
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
                            square += gap * gap
                        s2[count], first[count], second[count] = square, i, j
                        count += square < r2
                        if count == BLOCK:
                            total += add(count, first, second, s2, w, a, x, v, forced, par, c1, c2)
                            count = 0
        return total + add(count, first, second, s2, w, a, x, v, forced, par, c1, c2)

    @njit(cache=True, error_model="numpy")
    def forces(q, p, r, par, c1, c2, u, room):
        order, start, rows = sort_into_grid(q, r)
        if start.size == 0:
            return False, 0.0
        x, v, forced = room[0], room[1], room[2]
        for k in range(order.size):
            for c in range(m):
                x[k, c], v[k, c], forced[k, c] = q[order[k], c], p[order[k], c], 0.0
        near, block = np.empty((2, BLOCK), np.uint64), np.empty((3, BLOCK))
        total = sweep(start, rows, x, v, forced, max(r * r, 5e-324), par, c1, c2, near, block)
        for k in range(order.size):
            for c in range(m):
                u[order[k], c] += forced[k, c]
        return True, total

    @njit(cache=True, error_model="numpy")
    def forces_of(q, p, first, second, par, c1, c2, u):
        total = 0.0 * digest
        s2, w, a = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
        for begin in range(0, first.size, BLOCK):
            i, j = first[begin : begin + BLOCK], second[begin : begin + BLOCK]
            for k in range(i.size):
                s2[k] = 0.0
                for c in range(m):
                    s2[k] += (q[j[k], c] - q[i[k], c]) ** 2
            total += add(i.size, i, j, s2, w, a, q, p, u, par, c1, c2)
        return total

    return forces, forces_of
