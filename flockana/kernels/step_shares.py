"""Accepted share of a step: no agent skips an obstacle, no pair skips an encounter or a pole.

A template (`flockana.kernels.bound_templates`): a run compiles only the checks that its law needs.
"""

import numpy as np

from flockana.jit import inlined, kernel
from flockana.kernels.encounters import band, common_way, farthest_ways, share_of_listed, steepest
from flockana.kernels.grid import sort_into_grid
from flockana.kernels.neighbours import fill_from_grid
from flockana.kernels.pole_crossings import crossing_listed
from flockana.kernels.quintic_paths import bernstein
from flockana.kernels.runge_kutta import frame_at
from flockana.kernels.verlet import COUNT, CROWDED, SKIN

# Whether there are obstacles, encounters or poles of pairs, poles, and pairs too many for a list.
BODIES = True  # bound
PAIRS = True  # bound
POLES = True  # bound
CROWD = True  # bound

POLE, TOO_MANY, NO_ROOM = -0.5, -2.0, -3.0  # a step that crossed a pole is halved; pairs are too many for any list
_BLOCK = 2**16  # pairs looked at together where a list of all would not fit into memory


@inlined
def _at_rest(t, h, points, view):
    """Return the paths in the frame in which the obstacles are at rest."""
    places, m = points.copy(), view[1].size
    frame = np.empty((2, m))
    for k in range(6):
        frame_at(t + 0.2 * k * h, view, frame)
        for i in range(len(points)):
            for c in range(m):
                places[i, k, c] += frame[0, c]
    return places


@inlined
def _share_of(ends, whole, around, first, second, share):
    """Return the share of a step allowed by given pairs, if less than `share`; negative if a pole is crossed."""
    common, ways, between = whole
    if POLES and not around.few:
        beside = steepest(common[1]), ways[0] + ways[1]
        if crossing_listed(ends, beside, around.poles, around.toward, first, second):
            return POLE
    return (
        share_of_listed(ends, (common[0], ways[1]), between, around, first, second, share)
        if around.radii.size
        else share
    )


@inlined
def _share_of_crowd(ends, whole, around, share):
    """Return the share of a step allowed by all close pairs, found block by block without a list."""
    q0, within = ends.q0, whole[2][1]
    (n, m), cell, row = q0.shape, np.int64(0), np.int64(0)  # typed, as in `advance`
    grid, x = sort_into_grid(q0, within), np.empty(q0.shape)
    for i in range(n):
        for c in range(m):
            x[i, c] = q0[grid[0][i], c]
    first, second = np.empty(max(_BLOCK, n), np.uint32), np.empty(max(_BLOCK, n), np.uint32)
    while row < n and share >= 0.0:
        cell, row, count = fill_from_grid(x, grid, within * within, cell, row, first, second)
        share = _share_of(ends, whole, around, first[:count], second[:count], share)
    return share


@kernel
def share_of_step(t, ends, around, view, kept, near):
    """Return the accepted fraction of a step; negative codes are POLE, TOO_MANY and NO_ROOM.

    The list `kept` is the integrator's, `near` that of these checks, which is made anew where neither holds all pairs
    that may meet.
    """
    share = 1.0
    if BODIES:
        points, _, allowance = bernstein(*ends)
        places = _at_rest(t, ends.h, points, view)
        share = around.guard(places, allowance, around.numbers, around.starts, around.shell[0], around.shell[1], share)
    if PAIRS and len(ends.q0) > 1:
        common = common_way(ends)
        ways = farthest_ways(ends, common)
        between = band(common, ways, around.edges, around.far)
        if POLES and around.few:
            beside = steepest(common[1]), ways[0] + ways[1]
            if crossing_listed(ends, beside, around.poles, around.toward, around.first, around.second):
                return POLE
            if not around.radii.size:
                return share
        rows_kept = kept
        if not around.covers(kept, ends.q0, between[1]):
            if not around.covers(near, ends.q0, between[1]):
                around.listed(ends.q0, (1.0 + SKIN) * between[1], near)
            rows_kept = near
        count = rows_kept.counts[COUNT]
        if count >= 0:
            first, second = rows_kept.first[:count], rows_kept.second[:count]
            share = _share_of(ends, (common, ways, between), around, first, second, share)
        elif count < CROWDED:
            share = NO_ROOM
        elif CROWD:
            share = _share_of_crowd(ends, (common, ways, between), around, share)
        else:
            share = TOO_MANY
    return share
