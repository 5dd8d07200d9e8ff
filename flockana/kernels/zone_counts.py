"""Numbers of agents in each other's zones, and of components of the flock, at each instant of a run."""

from __future__ import annotations

from math import sqrt

import numpy as np

from flockana.jit import kernel
from flockana.kernels.candidates import gather, sort_into_cells
from flockana.kernels.sums import square_between


@kernel
def _count_neighbours(q, r, c, a, cells, near, shares):
    """Add to (3,) shares how many agents are in the zones of repulsion, conflict and attraction of one, on average."""
    n = len(q)
    for i in range(n):
        for j in near[: gather(i, q, a[i], cells, near)]:
            d2 = square_between(q, i, j)
            d = sqrt(d2)
            if j == i or d > a[i]:
                continue
            shares[0 if d <= r[i] else 1 if d <= c[i] else 2] += 1.0 / n


@kernel
def populations(q, r, c, a):
    """Mean number of agents in the zones of repulsion, conflict and attraction of an agent, (T, n, m) -> (T, 3)."""
    shares, near = np.zeros((q.shape[0], 3)), np.empty(q.shape[1], np.int64)
    for t in range(q.shape[0]):
        _count_neighbours(q[t], r, c, a, sort_into_cells(q[t], a.max()), near, shares[t])
    return shares


@kernel
def _count_fragments(q, a, reach, cells, near, seen, stack):
    """(components, agents in the largest); `seen` and `stack` are room."""
    n, components, largest = len(q), 0, 0
    for i in range(n):
        seen[i] = False
    for root in range(n):
        if seen[root]:
            continue
        seen[root], stack[0], waiting, size = True, root, 1, 0
        while waiting:
            waiting -= 1
            i = stack[waiting]
            size += 1
            for j in near[: gather(i, q, reach, cells, near)]:
                d2 = square_between(q, i, j)
                if not seen[j] and sqrt(d2) <= max(a[i], a[j]):
                    seen[j], stack[waiting] = True, j
                    waiting += 1
        components += 1
        largest = max(largest, size)
    return components, largest


@kernel
def fragments(q, a):
    """(components, agents in the largest) over time, (T, 2); two agents are linked if one attracts the other."""
    steps, n, _ = q.shape
    counts, reach = np.zeros((steps, 2), np.int64), a.max()
    seen, stack, near = np.empty(n, np.bool_), np.empty(n, np.int64), np.empty(n, np.int64)
    for t in range(steps):
        cells = sort_into_cells(q[t], reach)
        counts[t, 0], counts[t, 1] = _count_fragments(q[t], a, reach, cells, near, seen, stack)
    return counts
