"""Least and greatest distances of a flock at many instants, over all pairs: for few agents faster than any search."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from flockana.kernels.compiling import njit


@njit(cache=True)
def least_distances(q):
    """Least distance between two agents at each instant, shape (T,) of (T, n, m); ∞ for one agent."""
    distances = np.empty(len(q))
    for k in range(len(q)):
        least = inf
        for i in range(q.shape[1]):
            for j in range(i):
                s2 = 0.0
                for c in range(q.shape[2]):
                    s2 += (q[k, j, c] - q[k, i, c]) ** 2
                least = min(least, s2)
        distances[k] = sqrt(least)
    return distances


@njit(cache=True)
def greatest_distances(q):
    """Greatest distance between two agents at each instant, shape (T,) of (T, n, m); 0 for one agent."""
    distances = np.empty(len(q))
    for k in range(len(q)):
        most = 0.0
        for i in range(q.shape[1]):
            for j in range(i):
                s2 = 0.0
                for c in range(q.shape[2]):
                    s2 += (q[k, j, c] - q[k, i, c]) ** 2
                most = max(most, s2)
        distances[k] = sqrt(most)
    return distances
