"""Whether a step leapt over an encounter: two agents in and out of each other's reach between two evaluations.

The paths of a step are the quintics through its ends (`flockana.kernels.paths`). All arrays of paths, reaches and
allowances are those of `control_points`; those of many agents are not kept, but made again for the few pairs that may
matter.
"""

from __future__ import annotations

import numpy as np

from flockana.kernels.compiling import njit
from flockana.kernels.copies import put
from flockana.kernels.paths import _DEPTH, ALLOWED, _first_touch, _hull_bound, quintic, reach_of
from flockana.kernels.sums import column_mean

_STRIP = 512  # agents at once
_WIDER = 1.0 + 1e-9  # for the rounding of bounds
SLACK = 1.1  # a step that is too long by less than this is not worth another


@njit(cache=True, _nrt=False)
def _load(points, i, j, curve):
    """The pair's relative control points into `curve`; the largest distance from the first of them."""
    way = 0.0
    for k in range(6):
        s2 = 0.0
        for x in range(3):
            curve[k, x] = points[j, k, x] - points[i, k, x]
            s2 += (curve[k, x] - curve[0, x]) ** 2
        way = max(way, s2)
    return np.sqrt(way)


@njit(cache=True, _nrt=False)
def _ahead(points, i, j, s, far, room):
    """How much of the step lies between s and the pair's next closest approach, or a way of `far`; -1 if it parts.

    `room` is for six control points.
    """
    closing, speed2 = 0.0, 0.0
    for x in range(3):
        b = room[:, x]
        for k in range(6):
            b[k] = points[j, k, x] - points[i, k, x]
        for level in range(4):
            for k in range(5 - level):
                b[k] += s * (b[k + 1] - b[k])
        at, rate = b[0] + s * (b[1] - b[0]), 5.0 * (b[1] - b[0])
        closing -= at * rate
        speed2 += rate * rate
    if closing <= 0.0:
        return -1.0
    return min(closing / speed2, far / np.sqrt(speed2))


@njit(cache=True, _nrt=False)
def _visit(points, i, j, edge, far, stack, spans):
    """Share of the step at which a pair that starts beyond `edge` is first well within it; 1 if it ends so.

    Well within is at its closest approach, or as soon as it has gone `far` there.
    """
    _load(points, i, j, stack[0])
    if _hull_bound(stack[0]) >= edge:
        return 1.0
    s = _first_touch(stack, spans, edge)
    if s < 0.0:
        return 1.0
    ahead = _ahead(points, i, j, s, far, stack[1])
    return 1.0 if ahead < 0.0 or s + SLACK * ahead >= 1.0 else s + ahead


@njit(cache=True, _nrt=False)
def _apart2(points, i, j, k):
    """Squared distance of the pair's control points k."""
    x, y, z = points[j, k, 0] - points[i, k, 0], points[j, k, 1] - points[i, k, 1], points[j, k, 2] - points[i, k, 2]
    return x * x + y * y + z * z


@njit(cache=True, _nrt=False)
def _share(points, reach, allowance, radii, far, i, j, share, stack, spans):
    """The share of the step that one pair allows, if less than `share`."""
    s2, travel, slack = _apart2(points, i, j, 0), reach[i] + reach[j], allowance[i] + allowance[j]
    last = radii.shape[1] - 1
    outer = max(radii[i, last], radii[j, last]) + slack
    if s2 >= (outer + travel) ** 2:
        return share
    if travel > far and s2 < outer * outer:
        way = _load(points, i, j, stack[0])
        if way > SLACK * far:
            share = min(share, far / way)
    for k in range(last + 1):
        for whose in range(2):
            radius = radii[i, k] if whose == 0 else radii[j, k]
            if whose == 1 and radius == radii[i, k]:
                continue
            edge = radius + slack
            if s2 < edge * edge or s2 >= (edge + travel) ** 2:
                continue
            if travel <= far and _apart2(points, i, j, 5) < edge * edge:
                continue  # the evaluation at the end of the step meets it
            share = min(share, _visit(points, i, j, edge, far, stack, spans))
    return share


@njit(cache=True)
def _band(reach, allowance, radii, far):
    """Squared distances between which a pair may cut the step short: nearly all are let pass by theirs alone."""
    travel = 2.0 * reach.max()
    low = radii[:, 0].min() if travel <= far else 0.0
    high = radii[:, -1].max() + 2.0 * allowance.max() + travel
    return low * low, high * high


@njit(cache=True)
def share_of_all(points, reach, allowance, radii, far):
    """The largest share of the step, at most 1, within which no pair of the flock leaps over an encounter."""
    stack, spans, share = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2)), 1.0
    n, (low2, high2) = radii.shape[0], _band(reach, allowance, radii, far)
    x, y, z = points[:, 0, 0].copy(), points[:, 0, 1].copy(), points[:, 0, 2].copy()
    for i in range(n):
        for j in range(i + 1, n):
            a, b, c = x[j] - x[i], y[j] - y[i], z[j] - z[i]
            s2 = a * a + b * b + c * c
            if low2 <= s2 < high2:
                share = _share(points, reach, allowance, radii, far, i, j, share, stack, spans)
    return share


@njit(cache=True)
def share_of_pairs(points, reach, allowance, radii, far, first, second, share):
    """As `share_of_all`, of the pairs given, if less than `share`."""
    stack, spans = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2))
    low2, high2 = _band(reach, allowance, radii, far)
    for k in range(first.size):
        i, j = np.int64(first[k]), np.int64(second[k])
        if low2 <= _apart2(points, i, j, 0) < high2:
            share = _share(points, reach, allowance, radii, far, i, j, share, stack, spans)
    return share


@njit(cache=True, error_model="numpy", nogil=True)
def mean_way(h, q0, p0, u0, q1, p1, u1):
    """How far the control points of the flock's mean path are from the first of them, (6, 3)."""
    way = np.zeros((6, 3))
    for c in range(q0.shape[1]):
        gone = column_mean(q1, c) - column_mean(q0, c)
        out, back = h * column_mean(p0, c) / 5.0, h * column_mean(p1, c) / 5.0
        way[1, c], way[2, c] = out, 2.0 * out + h * h * column_mean(u0, c) / 20.0
        way[3, c], way[4, c] = gone - 2.0 * back + h * h * column_mean(u1, c) / 20.0, gone - back
        way[5, c] = gone
    return way


@njit(cache=True, error_model="numpy", nogil=True)
def farthest_ways(h, q0, p0, u0, q1, p1, u1, mean):
    """(the longest way of an agent beside the mean one, the largest allowance): of `control_points`, to rounding."""
    n, m = q0.shape
    ways, off = np.empty((5, _STRIP)), np.empty((2, _STRIP))
    far, blur, s, z = 0.0, 0.0, h / 5.0, h * h / 20.0
    for begin in range(0, n, _STRIP):
        count = min(_STRIP, n - begin)
        ways[:], off[:] = 0.0, 0.0
        for c in range(m):
            m1, m2, m3, m4, m5 = mean[1, c], mean[2, c], mean[3, c], mean[4, c], mean[5, c]
            for k in range(count):
                i = begin + k
                gone, out, back = q1[i, c] - q0[i, c], s * p0[i, c], s * p1[i, c]
                bend0, bend1 = z * u0[i, c], z * u1[i, c]
                ways[0, k] += (out - m1) ** 2
                ways[1, k] += (2.0 * out + bend0 - m2) ** 2
                ways[2, k] += (gone - 2.0 * back + bend1 - m3) ** 2
                ways[3, k] += (gone - back - m4) ** 2
                ways[4, k] += (gone - m5) ** 2
                off[0, k] += (out + 0.5 * back + bend0 - 0.3 * gone) ** 2
                off[1, k] += (0.3 * gone - back - 0.5 * out + bend1) ** 2
        for k in range(count):
            way = max(max(max(ways[0, k], ways[1, k]), max(ways[2, k], ways[3, k])), ways[4, k])
            slack = ALLOWED * (np.sqrt(off[0, k]) + np.sqrt(off[1, k]))
            far, blur = max(far, np.sqrt(way) + slack), max(blur, slack)
    return far, blur


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def _share_of_band(h, ends, mean, low2, high2, radii, far, first, second, share, room):
    """The share that the pairs allow whose squared distance is in a band where the step begins."""
    (q0, p0, u0, q1, p1, u1), (stack, spans, points, reach, allowance, own) = ends, room
    m = q0.shape[1]
    for k in range(first.size):
        i, j = np.uint64(first[k]), np.uint64(second[k])
        s2 = 0.0
        for c in range(m):
            s2 += (q0[j, c] - q0[i, c]) ** 2
        if low2 <= s2 < high2:
            for a in range(2):
                one = i if a == 0 else j
                put(radii[one], own[a])
                allowance[a] = quintic(h, q0[one], p0[one], u0[one], q1[one], p1[one], u1[one], points[a])
                for node in range(6):  # by its indices: compiled code does not check that shapes agree
                    for c in range(m):
                        points[a, node, c] -= mean[node, c]
                reach[a] = reach_of(points[a]) + allowance[a]
            share = _share(points, reach, allowance, own, far, 0, 1, share, stack, spans)
    return share


@njit(cache=True, error_model="numpy", nogil=True)
def share_of_listed(h, q0, p0, u0, q1, p1, u1, mean, farthest, radii, far, first, second, share):
    """As `share_of_pairs` of the paths between two states: control points only of pairs that may matter."""
    stack, spans = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2))
    points, reach, allowance = np.zeros((2, 6, 3)), np.empty(2), np.empty(2)
    own, (way, blur) = np.empty((2, radii.shape[1])), farthest
    travel = 2.0 * way * _WIDER
    low, high = radii[0, 0], radii[0, -1]
    for agent in range(1, len(radii)):
        low, high = min(low, radii[agent, 0]), max(high, radii[agent, -1])
    low, high = low if travel <= far else 0.0, (high + 2.0 * blur + travel) * _WIDER
    ends, room = (q0, p0, u0, q1, p1, u1), (stack, spans, points, reach, allowance, own)
    return _share_of_band(h, ends, mean, low * low, high * high, radii, far, first, second, share, room)
