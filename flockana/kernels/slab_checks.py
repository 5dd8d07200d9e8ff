"""Checks of a large flock's steps, computed group by group of agents with one thread or several.

The parts are the same for any number of threads, and so are the results.
"""

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import kernel, parallel, prange, register_jitable
from flockana.kernels.encounter_checks import bounds_of, squares_beside

PARTS = 64  # of the agents, or of a list of pairs


class Reaches(NamedTuple):
    """Distances between agents, poles included, that no step may skip, with limits of the check."""

    radii: Any
    far: Any
    edges: Any
    poles: Any
    toward: Any
    few: Any


@register_jitable
def begin_of(part, count):
    """Return the index of the first agent or pair of one of the equal groups that threads work on."""
    return np.int64(part) * np.int64(count) // PARTS


@register_jitable
def _sum_part(ends, part, sums):
    """Write a group's sums of positions, velocities and accelerations at both ends of a step."""
    _, q0, p0, u0, q1, p1, u1 = ends
    for c in range(q0.shape[1]):
        sum_q0 = sum_p0 = sum_u0 = sum_q1 = sum_p1 = sum_u1 = 0.0
        for i in range(begin_of(part, len(q0)), begin_of(part + 1, len(q0))):
            sum_q0, sum_p0, sum_u0 = sum_q0 + q0[i, c], sum_p0 + p0[i, c], sum_u0 + u0[i, c]
            sum_q1, sum_p1, sum_u1 = sum_q1 + q1[i, c], sum_p1 + p1[i, c], sum_u1 + u1[i, c]
        sums[0, c], sums[1, c], sums[2, c] = sum_q0, sum_p0, sum_u0
        sums[3, c], sums[4, c], sums[5, c] = sum_q1, sum_p1, sum_u1


@kernel
def means_in_parts(ends):
    """Return the means of positions, velocities and accelerations at both ends of a step, by groups."""
    n, m = ends.q0.shape
    sums, means = np.empty((PARTS, 6, m)), np.zeros((6, m))
    for part in prange(PARTS):
        _sum_part(ends, np.int64(part), sums[part])
    for part in range(PARTS):
        for k in range(6):
            for c in range(m):
                means[k, c] += sums[part, k, c]
    for k in range(6):
        for c in range(m):
            means[k, c] /= n
    return means


@register_jitable
def _square_part(ends, mean, slope, centre, part, squares):
    """Write the largest squared deviations of a group of agents from the flock's common displacement."""
    n = len(ends.q0)
    begin, end = begin_of(part, n), begin_of(part + 1, n)
    squares[0], squares[1], squares[2] = squares_beside(ends, (mean, slope, centre), begin, end)


@kernel
def ways_in_parts(ends, mean, slope, centre):
    """Return bounds of the longest relative path of an agent and of its allowance, computed by groups."""
    squares, way2, most2, most3 = np.empty((PARTS, 3)), 0.0, 0.0, 0.0
    for part in prange(PARTS):
        _square_part(ends, mean, slope, centre, np.int64(part), squares[part])
    for part in range(PARTS):
        way2, most2, most3 = max(way2, squares[part, 0]), max(most2, squares[part, 1]), max(most3, squares[part, 2])
    return bounds_of(way2, most2, most3)


parallel_means_in_parts, parallel_ways_in_parts = parallel(means_in_parts), parallel(ways_in_parts)
