"""Distances of points and straight ways from the boundary of a polygon, and whether they meet it.

Distances are computed in the order in which GEOS does it, so they are those of shapely; which side a point is on, and
whether a way crosses an edge, is decided by signs that are certain, else UNSURE. Edges are rows (x0, y0, x1, y1).
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from flockana.jit import kernel
from flockana.kernels.segments import UNSURE, meet, turn

_ROUNDING = 1e-12  # of the lengths that are compared, some thousand times what a distance is off by
_FARTHER = (1.0 + 1e-9) ** 2


@kernel
def _apart(x, y, ax, ay):
    return sqrt((x - ax) * (x - ax) + (y - ay) * (y - ay))


@kernel
def _from_segment(x, y, ax, ay, bx, by):
    """Distance of a point from a segment, as GEOS's `Distance::pointToSegment` has it."""
    sx, sy = bx - ax, by - ay
    length2 = sx * sx + sy * sy
    if length2 == 0.0:
        return _apart(x, y, ax, ay)
    share = ((x - ax) * sx + (y - ay) * sy) / length2
    if share <= 0.0:
        return _apart(x, y, ax, ay)
    if share >= 1.0:
        return _apart(x, y, bx, by)
    return abs(((ay - y) * sx - (ax - x) * sy) / length2) * sqrt(length2)


@kernel
def _inside(x, y, edges):
    """Whether a point is inside: 1, 0 or UNSURE; 0 on the boundary."""
    inside = 0
    for k in range(len(edges)):
        ax, ay, bx, by = edges[k, 0], edges[k, 1], edges[k, 2], edges[k, 3]
        if (ay > y) == (by > y):
            continue
        side = turn(ax, ay, bx, by, x, y)
        if side == UNSURE or side == 0:
            return side
        if (side == 1) == (by > ay):  # the edge is to the right
            inside = 1 - inside
    return inside


@kernel
def from_boundary(q, edges):
    """Distance of points (N, 2) from the boundary, and whether each is inside: 1, 0 or UNSURE; 0 at no distance.

    Examples
    --------
    >>> edges = np.array([[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 0.0, 4.0], [0.0, 4.0, 0.0, 0.0]])
    >>> distance, inside = from_boundary(np.array([[1.0, 1.0], [-3.0, -4.0]]), edges)
    >>> distance.tolist(), inside.tolist()
    ([1.0, 5.0], [1, 0])
    """
    distance, inside = np.full(len(q), inf), np.zeros(len(q), np.int8)
    for i in range(len(q)):
        x, y = q[i, 0], q[i, 1]
        for k in range(len(edges)):
            off = _from_segment(x, y, edges[k, 0], edges[k, 1], edges[k, 2], edges[k, 3])
            distance[i] = min(distance[i], off)
        inside[i] = _inside(x, y, edges) if distance[i] > 0.0 else 0
    return distance, inside


@kernel
def _in_one_box(ax, ay, bx, by, cx, cy, dx, dy):
    """Whether the boxes of two segments overlap."""
    apart = max(ax, bx) < min(cx, dx) or max(cx, dx) < min(ax, bx)
    return not (apart or max(ay, by) < min(cy, dy) or max(cy, dy) < min(ay, by))


@kernel
def _cross(ax, ay, bx, by, cx, cy, dx, dy):
    """Whether GEOS's `Distance::segmentToSegment` finds a point that two segments share: their distance is 0."""
    det = (bx - ax) * (dy - cy) - (by - ay) * (dx - cx)
    if det == 0.0:
        return False
    r, s = (ay - cy) * (dx - cx) - (ax - cx) * (dy - cy), (ay - cy) * (bx - ax) - (ax - cx) * (by - ay)
    return 0.0 <= r / det <= 1.0 and 0.0 <= s / det <= 1.0


@kernel
def _crossings(ax, ay, bx, by, edges):
    """Whether a way meets an edge, 1, 0 or UNSURE, and whether one crosses it as GEOS computes it."""
    met, zero = 0, False
    for k in range(len(edges)):
        cx, cy, dx, dy = edges[k, 0], edges[k, 1], edges[k, 2], edges[k, 3]
        if not _in_one_box(ax, ay, bx, by, cx, cy, dx, dy):
            continue
        zero = zero or _cross(ax, ay, bx, by, cx, cy, dx, dy)
        c, d = turn(ax, ay, bx, by, cx, cy), turn(ax, ay, bx, by, dx, dy)
        a, b = turn(cx, cy, dx, dy, ax, ay), turn(cx, cy, dx, dy, bx, by)
        meeting = meet(c, d, a, b)
        met = meeting if met == 0 or meeting == 1 else met
    return met, zero


@kernel
def _from_corners(ax, ay, bx, by, edges, least, length):
    """The lesser of `least` and the distance of the corners from a way; what is too far to matter is left out."""
    near2 = (least + length) * (least + length) * _FARTHER
    for k in range(len(edges)):
        cx, cy = edges[k, 0], edges[k, 1]
        if (cx - ax) * (cx - ax) + (cy - ay) * (cy - ay) <= near2:
            least = min(least, _from_segment(cx, cy, ax, ay, bx, by))
    return least


@kernel
def ways_from_boundary(start, end, at_start, at_end, edges):
    """Distance of straight ways from the boundary, and whether each meets the polygon: 1, 0 or UNSURE.

    Examples
    --------
    >>> edges = np.array([[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 0.0, 4.0], [0.0, 4.0, 0.0, 0.0]])
    >>> start, end = np.array([[-1.0, 1.0], [-2.0, -1.0]]), np.array([[9.0, 1.0], [2.0, -1.0]])
    >>> distance, met = ways_from_boundary(start, end, np.array([1.0, np.sqrt(5.0)]), np.array([6.0, 1.0]), edges)
    >>> distance.tolist(), met.tolist()
    ([0.0, 1.0], [1, 0])
    """
    distance, met, size = np.empty(len(start)), np.zeros(len(start), np.int8), 0.0
    for k in range(len(edges)):
        size = max(size, _apart(edges[k, 0], edges[k, 1], edges[0, 0], edges[0, 1]))
    for i in range(len(start)):
        ax, ay, bx, by = start[i, 0], start[i, 1], end[i, 0], end[i, 1]
        here, there, length = abs(at_start[i]), abs(at_end[i]), _apart(ax, ay, bx, by)
        least, zero = min(here, there), False
        # a way that meets the boundary is at least as long as both its ends are away from it
        if here + there <= length + _ROUNDING * (here + there + length + size):
            met[i], zero = _crossings(ax, ay, bx, by, edges)
        if at_start[i] < 0.0 or at_end[i] < 0.0:
            met[i] = 1
        if length > 0.0:
            least = _from_corners(ax, ay, bx, by, edges, least, length)
        distance[i] = 0.0 if zero else least
    return distance, met
