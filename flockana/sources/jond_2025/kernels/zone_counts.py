"""Counts of agents in zones and of flock components, at each instant of a run."""

from math import sqrt

import numpy as np
import numpy.typing as npt

from flockana.jit import kernel
from flockana.kernels.agent_sums import square_between
from flockana.kernels.connected_components import labelled, merge, root_of, unite
from flockana.kernels.neighbours import DENSE_MAX, FloatArray, IndexArray, pair_list

_SLACK = 1.0 + 1e-12  # the search is strict, and the zones are closed


def _pairs(q: FloatArray, reach: float) -> tuple[IndexArray, IndexArray, FloatArray]:
    """Return (i, j, distance) of all pairs within reach."""
    i, j = pair_list(q, reach * _SLACK)
    return i, j, np.sqrt(np.sum((q[j] - q[i]) ** 2, axis=1))


def populations(q: FloatArray, r: FloatArray, c: FloatArray, a: FloatArray) -> FloatArray:
    """Return the mean numbers of agents in an agent's zones of repulsion, conflict, attraction, (T, n, m) -> (T, 3)."""
    counts = np.zeros((len(q), 3))
    for positions, count in zip(q, counts, strict=True):
        i, j, d = _pairs(positions, float(a.max()))
        for agent in (i, j):
            zone = np.add(d > r[agent], d > c[agent], dtype=np.int64)
            count += np.bincount(zone[d <= a[agent]], minlength=3)
    return counts / q.shape[1]


def fragments(q: FloatArray, a: FloatArray) -> npt.NDArray[np.int64]:
    """Return (components, agents in the largest) over time, (T, 2), with links by the attraction zone."""
    counts = np.zeros((len(q), 2), np.int64)
    if q.shape[1] <= DENSE_MAX:
        _count_fragments(q, a, counts)
        return counts
    for positions, count in zip(q, counts, strict=True):
        (i, j, d), parent = _pairs(positions, float(a.max())), np.arange(q.shape[1], dtype=np.int32)
        is_linked = d <= np.maximum(a[i], a[j])
        unite(parent, i[is_linked], j[is_linked])
        sizes = np.bincount(labelled(parent))
        count[:] = sizes.size, sizes.max()
    return counts


@kernel
def _count_fragments(q, a, out):
    """Write (components, agents in the largest) at each instant of a small flock, looking at all its pairs."""
    n = q.shape[1]
    parent, sizes = np.empty(n, np.int32), np.empty(n, np.int64)
    for k in range(q.shape[0]):
        for i in range(n):
            parent[i], sizes[i] = i, 0
        for i in range(n):
            for j in range(i):
                if sqrt(square_between(q[k], j, i)) <= max(a[i], a[j]):
                    merge(parent, i, j)
        for i in range(n):
            sizes[root_of(parent, i)] += 1
        for i in range(n):
            out[k, 0] += sizes[i] > 0
            out[k, 1] = max(out[k, 1], sizes[i])
