"""Whether a step leapt over an encounter: two agents in and out of each other's reach between two evaluations.

The paths of a step are the quintics through its ends (`flockana.kernels.paths`). All arrays of paths, reaches and
allowances are those of `control_points`.
"""

from __future__ import annotations

import numpy as np

from flockana.kernels.compiling import njit
from flockana.kernels.paths import _DEPTH, _first_touch, _hull_bound

SLACK = 1.1  # a step that is too long by less than this is not worth another


@njit(cache=True)
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


@njit(cache=True)
def _ahead(points, i, j, s, far):
    """How much of the step lies between s and the pair's next closest approach, or a way of `far`; -1 if it parts."""
    closing, speed2 = 0.0, 0.0
    for x in range(3):
        b = np.empty(6)
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


@njit(cache=True)
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
    ahead = _ahead(points, i, j, s, far)
    return 1.0 if ahead < 0.0 or s + SLACK * ahead >= 1.0 else s + ahead


@njit(cache=True)
def _apart2(points, i, j, k):
    """Squared distance of the pair's control points k."""
    x, y, z = points[j, k, 0] - points[i, k, 0], points[j, k, 1] - points[i, k, 1], points[j, k, 2] - points[i, k, 2]
    return x * x + y * y + z * z


@njit(cache=True)
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
