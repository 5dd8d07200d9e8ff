"""Accepted share of a step: no agent skips an obstacle, no pair skips an encounter or a pole.

A template (`flockana.kernels.bound_templates`): a run compiles only the checks that its law needs.
"""

from zlib import crc32

import numpy as np

from flockana.jit import inlined, kernel, parallel, prange, register_jitable
from flockana.kernels.cell_grid import sort_into_grid
from flockana.kernels.encounter_checks import band, common_way, farthest_ways, share_of_listed, steepest, way_of_means
from flockana.kernels.neighbours import fill_from_grid
from flockana.kernels.pole_crossings import crossing_listed
from flockana.kernels.quintic_paths import bernstein
from flockana.kernels.runge_kutta import frame_at
from flockana.kernels.slab_checks import (
    PARTS,
    Reaches,
    begin_of,
    means_in_parts,
    parallel_means_in_parts,
    parallel_ways_in_parts,
    ways_in_parts,
)
from flockana.kernels.verlet_list import COUNT, CROWDED, SKIN

# Whether there are obstacles, encounters or poles of pairs, poles, and pairs too many for a list; whether the flock is
# large, and then looked at in parts, and whether by several threads.
BODIES = True  # bound
PAIRS = True  # bound
POLES = True  # bound
CROWD = True  # bound
LARGE = False  # bound
SEVERAL = False  # bound

POLE, TOO_MANY, NO_ROOM = -0.5, -2.0, -3.0  # a step that crossed a pole is halved; pairs are too many for any list
_BLOCK = 2**16  # pairs looked at together where a list of all would not fit into memory
OWN = np.zeros(0, f"S{crc32(__name__.encode()) % 2**24 + 1}")  # as in `flockana.kernels.pair_sums`


@inlined
def _at_rest(t, h, points, view):
    """Return the paths in the frame in which the obstacles are at rest."""
    rest_points, m = points.copy(), view[1].size
    frame = np.empty((2, m))
    for k in range(6):
        frame_at(t + 0.2 * k * h, view, frame)
        for i in range(len(points)):
            for c in range(m):
                rest_points[i, k, c] += frame[0, c]
    return rest_points


@inlined
def _share_of(ends, whole, around, first, second, share):
    """Return the fraction of a step that given pairs allow, at most `share`; negative at a crossed pole."""
    common_motion, path_bounds, distance_band = whole
    if POLES and not around.few:
        limits = steepest(common_motion[1]), path_bounds[0] + path_bounds[1]
        if crossing_listed(ends, limits, around.poles, around.toward, first, second):
            return POLE
    return (
        share_of_listed(ends, (common_motion[0], path_bounds[1]), distance_band, around, first, second, share)
        if around.radii.size
        else share
    )


@register_jitable
def _look_at_part(own, ends, common, numbers, reaches, first, second, part, shares):
    """Write the fraction of a step that a group of listed pairs allows."""
    begin, end = begin_of(part, first.size), begin_of(part + 1, first.size)
    whole = common, (numbers[0], numbers[1]), (numbers[2], numbers[3])
    radii, far_limit, poles, toward, few = reaches
    around = Reaches(radii, far_limit, (numbers[4], numbers[5]), poles, toward, few)
    shares[part] = _share_of(ends, whole, around, first[begin:end], second[begin:end], 1.0)


@kernel
def share_in_parts(ends, common, numbers, reaches, first, second):
    """Return the fraction of a step that listed pairs allow, group by group; `numbers` are bounds."""
    shares, marker, share = np.empty(PARTS), OWN[:0], 1.0
    for part in prange(PARTS):
        _look_at_part(marker, ends, common, numbers, reaches, first, second, np.int64(part), shares)
    for part in range(PARTS):
        share = min(share, shares[part])
    return share


parallel_share_in_parts = parallel(share_in_parts)


@inlined
def _ways_of(ends):
    """Return the agents' common displacement in a step, and bounds of their deviations from it."""
    if not LARGE:
        common = common_way(ends)
        return common, farthest_ways(ends, common)
    means = parallel_means_in_parts(ends) if SEVERAL else means_in_parts(ends)
    common = way_of_means(ends, means)
    return common, (parallel_ways_in_parts(ends, *common) if SEVERAL else ways_in_parts(ends, *common))


@inlined
def _share_of_list(ends, whole, around, first, second, share):
    """Return the fraction of a step that listed pairs allow; pairs of a large flock are taken by groups."""
    if not LARGE:
        return _share_of(ends, whole, around, first, second, share)
    common_motion, path_bounds, distance_band = whole
    numbers = path_bounds[0], path_bounds[1], distance_band[0], distance_band[1], around.edges[0], around.edges[1]
    reach_data = around.radii, around.far, around.poles, around.toward, around.few
    if SEVERAL:
        return min(share, parallel_share_in_parts(ends, common_motion, numbers, reach_data, first, second))
    return min(share, share_in_parts(ends, common_motion, numbers, reach_data, first, second))


@inlined
def _share_of_crowd(ends, whole, around, share):
    """Return the fraction of a step that all close pairs allow, found block by block without a list."""
    q0, limit = ends.q0, whole[2][1]
    (n, m), cell, row = q0.shape, np.int64(0), np.int64(0)  # typed, as in `advance`
    grid, x = sort_into_grid(q0, limit), np.empty(q0.shape)
    for i in range(n):
        for c in range(m):
            x[i, c] = q0[grid[0][i], c]
    first, second_agents = np.empty(max(_BLOCK, n), np.uint32), np.empty(max(_BLOCK, n), np.uint32)
    while row < n and share >= 0.0:
        cell, row, count = fill_from_grid(x, grid, limit * limit, cell, row, first, second_agents)
        share = _share_of(ends, whole, around, first[:count], second_agents[:count], share)
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
        common, ways = _ways_of(ends)
        between = band(common, ways, around.edges, around.far)
        if POLES and around.few:
            limits = steepest(common[1]), ways[0] + ways[1]
            if crossing_listed(ends, limits, around.poles, around.toward, around.first, around.second):
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
            share = _share_of_list(ends, (common, ways, between), around, first, second, share)
        elif count < CROWDED:
            share = NO_ROOM
        elif CROWD:
            share = _share_of_crowd(ends, (common, ways, between), around, share)
        else:
            share = TOO_MANY
    return share
