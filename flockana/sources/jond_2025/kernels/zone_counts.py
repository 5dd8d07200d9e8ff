"""Counts of agents in zones and of flock components, at each instant of a run."""

import numpy as np
import numpy.typing as npt

from flockana.kernels.connected_components import labelled, unite
from flockana.kernels.neighbours import FloatArray, IndexArray, pair_list

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
    for positions, count in zip(q, counts, strict=True):
        (i, j, d), parent = _pairs(positions, float(a.max())), np.arange(q.shape[1], dtype=np.int32)
        is_linked = d <= np.maximum(a[i], a[j])
        unite(parent, i[is_linked], j[is_linked])
        sizes = np.bincount(labelled(parent))
        count[:] = sizes.size, sizes.max()
    return counts
