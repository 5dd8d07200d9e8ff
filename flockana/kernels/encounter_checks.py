"""Check of a step for skipped encounters: two agents in and out of each other's reach between two evaluations.

The paths of a step are the quintics through its ends (`flockana.kernels.quintic_paths`). Paths of many agents are not
kept, but made again for the few pairs that may matter.
"""

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import inlined, subroutine
from flockana.kernels.agent_sums import column_mean, put_row, slope_along
from flockana.kernels.quintic_paths import _DEPTH, ALLOWED, _first_touch, _hull_bound, polygon, quintic, reach_of

_WIDER = 1.0 + 1e-9  # for the rounding of bounds
_STEEP = 0.5  # a slope from which on the common way says too little of how near two agents come
SLACK = 1.1  # a step that is too long by less than this is not worth another


class Ends(NamedTuple):
    """Length of a step, and positions, velocities and accelerations, each of shape (n, m), at both of its ends."""

    h: Any
    q0: Any
    p0: Any
    u0: Any
    q1: Any
    p1: Any
    u1: Any


class Around(NamedTuple):
    """Distances and obstacles that no step may skip (`flockana.dynamics.encounters.Encounters`)."""

    radii: Any  # (n, K): distances at which each agent begins or ceases to feel another
    far: Any  # how far two may go within them
    edges: Any  # the least and the largest distance between agents that matters
    poles: Any  # distances between agents that no step crosses
    toward: Any  # share of the way to a pole that a step may go
    first: Any  # the pairs that poles concern, if not all: uint32
    second: Any
    few: Any  # whether there are such pairs
    guard: Any  # what share of a step obstacles allow (`flockana.kernels.law_kernels.guard_of`)
    numbers: Any  # what it reads
    starts: Any
    shell: Any  # distance at which the force of obstacles begins, and how far an agent may go within it
    listed: Any  # how pairs are listed: `flockana.kernels.verlet_list.listed_anew`
    covers: Any  # and whether a list still holds all of them: `flockana.kernels.verlet_list.covers`


class PairRoom(NamedTuple):
    """Work space for the check of one pair of agents: curves, time spans, control points and bounds."""

    stack: Any
    spans: Any
    points: Any
    reach: Any
    allowance: Any
    radii: Any


@inlined
def pair_room(radii):
    """Return work space for the check of a pair of agents against a given number of distances."""
    points = np.empty((2, 6, 3))
    for row in range(2):
        for k in range(6):
            for c in range(3):
                points[row, k, c] = 0.0
    return PairRoom(
        np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2)), points, np.empty(2), np.empty(2), np.empty((2, radii))
    )


@subroutine
def relative_curve(points, curve):
    """Write a pair's relative control points into `curve`; return their largest distance from the first."""
    max_square = 0.0
    for k in range(6):
        s2 = 0.0
        for x in range(3):
            curve[k, x] = points[1, k, x] - points[0, k, x]
            s2 += (curve[k, x] - curve[0, x]) ** 2
        max_square = max(max_square, s2)
    return np.sqrt(max_square)


@inlined
def _ahead(points, s, far, room):
    """Return the fraction of a step to a pair's closest approach or a path of `far`; -1 if the pair parts.

    `room` is for six control points.
    """
    approach, speed2 = 0.0, 0.0
    for x in range(3):
        b = room[:, x]
        for k in range(6):
            b[k] = points[1, k, x] - points[0, k, x]
        for level in range(4):
            for k in range(5 - level):
                b[k] += s * (b[k + 1] - b[k])
        position, rate = b[0] + s * (b[1] - b[0]), 5.0 * (b[1] - b[0])
        approach -= position * rate
        speed2 += rate * rate
    if approach <= 0.0:
        return -1.0
    return min(approach / speed2, far / np.sqrt(speed2))


@inlined
def _visit(points, edge, far, stack, spans):
    """Return the fraction of a step at which a pair is first well within the distance `edge`, at most 1.

    Well within is at its closest approach, or as soon as it has gone `far` there.
    """
    relative_curve(points, stack[0])
    if _hull_bound(stack[0]) >= edge:
        return 1.0
    s = _first_touch(stack, spans, edge)
    if s < 0.0:
        return 1.0
    next_approach = _ahead(points, s, far, stack[1])
    return 1.0 if next_approach < 0.0 or s + SLACK * next_approach >= 1.0 else s + next_approach


@inlined
def _apart2(points, k):
    """Return the squared distance of two agents at the control point k of their paths."""
    x, y, z = points[1, k, 0] - points[0, k, 0], points[1, k, 1] - points[0, k, 1], points[1, k, 2] - points[0, k, 2]
    return x * x + y * y + z * z


@inlined
def share_of_pair(room, far, share):
    """Return the fraction of a step in which a pair skips no encounter, at most `share`."""
    points, radii = room.points, room.radii
    s2, reach_sum = _apart2(points, 0), room.reach[0] + room.reach[1]
    slack, last_index = room.allowance[0] + room.allowance[1], radii.shape[1] - 1
    outer = max(radii[0, last_index], radii[1, last_index]) + slack
    if s2 >= (outer + reach_sum) ** 2:
        return share
    if reach_sum > far and s2 < outer * outer:
        path_reach = relative_curve(points, room.stack[0])
        if path_reach > SLACK * far:
            share = min(share, far / path_reach)
    for k in range(last_index + 1):
        for agent in range(2):
            if agent == 1 and radii[1, k] == radii[0, k]:
                continue
            edge = radii[agent, k] + slack
            if s2 < edge * edge or s2 >= (edge + reach_sum) ** 2:
                continue
            if reach_sum <= far and _apart2(points, 5) < edge * edge:
                continue  # the evaluation at the end of the step meets it
            share = min(share, _visit(points, edge, far, room.stack, room.spans))
    return share


@subroutine
def steepest(slope):
    """Return the largest modulus of the slopes of the agents' common affine displacement."""
    maximum = 0.0
    for k in range(6):
        for c in range(3):
            maximum = max(maximum, abs(slope[k, c]))
    return maximum


@inlined
def means_of(ends):
    """Return the means of all agents' positions, velocities and accelerations at both ends, 6 × m."""
    _, q0, p0, u0, q1, p1, u1 = ends
    means = np.empty((6, q0.shape[1]))
    for c in range(q0.shape[1]):
        means[0, c], means[1, c], means[2, c] = column_mean(q0, c), column_mean(p0, c), column_mean(u0, c)
        means[3, c], means[4, c], means[5, c] = column_mean(q1, c), column_mean(p1, c), column_mean(u1, c)
    return means


@inlined
def way_of_means(ends, means):
    """Return (mean, slope, centre) of the agents' common displacement in a step, from given means."""
    h, q0, p0, u0, q1, p1, u1 = ends
    mean, slope, centre, s, z = np.empty((6, 3)), np.empty((6, 3)), np.empty(3), h / 5.0, h * h / 20.0
    for k in range(6):
        for c in range(3):
            mean[k, c] = slope[k, c] = 0.0
    for c in range(q0.shape[1]):
        centre[c], out, bend0 = means[0, c], means[1, c], means[2, c]
        back, bend1 = means[4, c], means[5, c]
        controls = polygon(0.0, means[3, c] - centre[c], s * out, s * back, z * bend0, z * bend1)
        _, mean[1, c], mean[2, c], mean[3, c], mean[4, c], mean[5, c] = controls
        out, back = slope_along(q0, p0, c, 0.0), slope_along(q0, p1, c, 0.0)
        bend0, bend1 = slope_along(q0, u0, c, 0.0), slope_along(q0, u1, c, 0.0)
        controls = polygon(0.0, slope_along(q0, q1, c, 1.0) - 1.0, s * out, s * back, z * bend0, z * bend1)
        _, slope[1, c], slope[2, c], slope[3, c], slope[4, c], slope[5, c] = controls
    if not steepest(slope) < _STEEP:
        for k in range(6):
            for c in range(3):
                slope[k, c] = 0.0
    return mean, slope, centre


@inlined
def common_way(ends):
    """Return (mean, slope, centre) of the agents' common displacement in a step, affine in their position.

    The slope is by how much a way along a coordinate grows with the place there, seen from the centre; none where it is
    steep.
    """
    return way_of_means(ends, means_of(ends))


@inlined
def squares_beside(ends, common, begin, end):
    """Return the largest squared deviations of some agents from the common displacement, with allowances."""
    (h, q0, p0, u0, q1, p1, u1), (mean, slope, centre) = ends, common
    m = q0.shape[1]
    way2 = most2 = most3 = 0.0
    s, z = h / 5.0, h * h / 20.0
    for i in range(begin, end):
        d1 = d2 = d3 = d4 = d5 = off2 = off3 = 0.0
        for c in range(m):
            past, out, back, offset = q1[i, c] - q0[i, c], s * p0[i, c], s * p1[i, c], q0[i, c] - centre[c]
            bend0, bend1 = z * u0[i, c], z * u1[i, c]
            _, w1, w2, w3, w4, w5 = polygon(0.0, past, out, back, bend0, bend1)
            d1 += (w1 - (mean[1, c] + slope[1, c] * offset)) ** 2
            d2 += (w2 - (mean[2, c] + slope[2, c] * offset)) ** 2
            d3 += (w3 - (mean[3, c] + slope[3, c] * offset)) ** 2
            d4 += (w4 - (mean[4, c] + slope[4, c] * offset)) ** 2
            d5 += (w5 - (mean[5, c] + slope[5, c] * offset)) ** 2
            off2 += (out + 0.5 * back + bend0 - 0.3 * past) ** 2
            off3 += (0.3 * past - back - 0.5 * out + bend1) ** 2
        way2, most2, most3 = max(way2, max(max(max(d1, d2), max(d3, d4)), d5)), max(most2, off2), max(most3, off3)
    return way2, most2, most3


@inlined
def farthest_ways(ends, common):
    """Return bounds of the agents' longest path relative to the common displacement and of its allowance."""
    way2, most2, most3 = squares_beside(ends, common, 0, len(ends.q0))
    return bounds_of(way2, most2, most3)


@inlined
def bounds_of(way2, most2, most3):
    """Return bounds of the longest relative path and of its allowance, from the largest squares of both."""
    allowance = ALLOWED * (np.sqrt(most2) + np.sqrt(most3))
    return np.sqrt(way2) + allowance, allowance


@inlined
def band(common, farthest, edges, far):
    """Return (low, high), the initial distances between which a pair may shorten the step.

    Two agents at the distance s go no farther, one seen from the other, than s times the steepest slope of the common
    way and twice the longest way beside it.
    """
    (path_reach, allowance), steepness, (low, high) = farthest, steepest(common[1]), edges
    high = (high + 2.0 * (allowance + path_reach)) / (1.0 - steepness) * _WIDER
    return low if (steepness * high + 2.0 * path_reach) * _WIDER <= far else 0.0, high


@inlined
def _stays_beyond(ends, i, j, edge):
    """Return whether a pair that starts beyond `edge` stays there, by its control points along the initial line."""
    h, q0, p0, u0, q1, p1, u1 = ends
    s2 = d1 = d2 = d3 = d4 = d5 = 0.0
    s, z = h / 5.0, h * h / 20.0
    for c in range(q0.shape[1]):
        gap, first_move, last_move = q0[j, c] - q0[i, c], s * (p0[j, c] - p0[i, c]), s * (p1[j, c] - p1[i, c])
        bend0, bend1 = z * (u0[j, c] - u0[i, c]), z * (u1[j, c] - u1[i, c])
        _, x1, x2, x3, x4, x5 = polygon(gap, q1[j, c] - q1[i, c], first_move, last_move, bend0, bend1)
        s2, d1, d2, d3 = s2 + gap * gap, d1 + gap * x1, d2 + gap * x2, d3 + gap * x3
        d4, d5 = d4 + gap * x4, d5 + gap * x5
    return min(min(s2, min(d1, d2)), min(d3, min(d4, d5))) >= edge * np.sqrt(s2) * _WIDER


@inlined
def share_of_listed(ends, common, between, around, first, second, share):
    """Return the largest share of the step, up to the given one, in which no listed pair skips an encounter.

    `common` are the mean control points and the largest allowance. Only pairs are looked at whose distance is within a
    band where the step begins.
    """
    (h, q0, p0, u0, q1, p1, u1), radii, (mean, allowance) = ends, around.radii, common
    workspace, low2, high2, count = pair_room(radii.shape[1]), between[0] ** 2, between[1] ** 2, 0
    m, outer, picked_pairs = q0.shape[1], around.edges[1] + 2.0 * allowance, np.empty(first.size + 1, np.uint32)
    for k in range(first.size):
        i, j, s2 = np.uint64(first[k]), np.uint64(second[k]), 0.0
        for c in range(m):
            s2 += (q0[j, c] - q0[i, c]) ** 2
        picked_pairs[count] = k
        count += (s2 >= low2) & (s2 < high2)
    for k in range(count):
        i, j = np.uint64(first[picked_pairs[k]]), np.uint64(second[picked_pairs[k]])
        if not _stays_beyond(ends, i, j, outer):
            for a in range(2):
                one, curve = i if a == 0 else j, workspace.points[a]
                put_row(radii[one], workspace.radii[a])
                workspace.allowance[a] = quintic(h, q0[one], p0[one], u0[one], q1[one], p1[one], u1[one], curve)
                for node in range(6):  # by its indices: compiled code does not check that shapes agree
                    for c in range(m):
                        curve[node, c] -= mean[node, c]
                workspace.reach[a] = reach_of(curve) + workspace.allowance[a]
            share = share_of_pair(workspace, around.far, share)
    return share
