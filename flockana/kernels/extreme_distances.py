"""Least and greatest distances of a flock at many instants; for few agents by testing all pairs."""

from math import inf, sqrt

import numpy as np

from flockana.jit import kernel
from flockana.kernels.agent_sums import column_mean


@kernel
def least_distances(q):
    """Return the least distance of two agents at each instant, shape (T,) of (T, n, m); ∞ for one agent.

    Each agent keeps the least square to those after it, so that the inner loop is compiled to SIMD.
    """
    count, n, m = q.shape
    distances, x, nearest = np.empty(count), np.zeros((3, n)), np.empty(n)
    for k in range(count):
        for i in range(n):
            for c in range(m):
                x[c, i] = q[k, i, c]
        for i in range(n):
            nearest[i] = inf
        for i in range(1, n):
            x0, x1, x2 = x[0, i], x[1, i], x[2, i]
            for j in range(i):
                s2 = (x[0, j] - x0) ** 2 + (x[1, j] - x1) ** 2 + (x[2, j] - x2) ** 2
                nearest[j] = min(nearest[j], s2)
        closest = inf
        for i in range(n):
            closest = min(closest, nearest[i])
        distances[k] = sqrt(closest)
    return distances


@kernel
def _square(x, i, place):
    total = 0.0
    for c in range(place.size):
        total += (x[i, c] - place[c]) ** 2
    return total


@kernel
def _farthest(x, place):
    """Return (agent, squared distance) of the agent farthest from a point."""
    agent, largest_square = 0, 0.0
    for i in range(len(x)):
        s2 = _square(x, i, place)
        if s2 > largest_square:
            agent, largest_square = i, s2
    return agent, largest_square


@kernel
def greatest_distances(q):
    """Return the greatest distance of two agents at each instant, shape (T,) of (T, n, m); 0 for one agent.

    Two agents are no farther from each other than both together from their centre: all pairs are looked at only of
    those so far out that they may be farther than two that are found at once.
    """
    distances, rim, centre = np.empty(len(q)), np.empty(q.shape[1], np.int64), np.empty(q.shape[2])
    for k in range(len(q)):
        x, count = q[k], 0
        for c in range(centre.size):
            centre[c] = column_mean(x, c)
        first_agent, outermost = _farthest(x, centre)
        second_agent, _ = _farthest(x, x[first_agent])
        _, largest_square = _farthest(x, x[second_agent])
        lower_bound = sqrt(largest_square) * (1.0 - 1e-9) - sqrt(outermost)
        for i in range(len(x)):
            if sqrt(_square(x, i, centre)) >= lower_bound:
                rim[count] = i
                count += 1
        for a in range(count):
            for b in range(a):
                s2 = 0.0
                for c in range(centre.size):
                    s2 += (x[rim[b], c] - x[rim[a], c]) ** 2
                largest_square = max(largest_square, s2)
        distances[k] = sqrt(largest_square)
    return distances
