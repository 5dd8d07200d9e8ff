"""Crossing and distance of segments, with signs of determinants bounded against rounding.

Signs of determinants are taken in floating point where a bound of the rounding error vouches for them (Shewchuk 1997)
and are handed back as UNSURE where it does not.
"""

import numpy as np

from flockana.jit import kernel, subroutine

UNSURE = 2
_TURN = 3.5 * 2.0**-53  # Shewchuk's bounds are (3 + 16u)u and (7 + 56u)u; the rest is slack for subnormal products
_VOLUME = 8.0 * 2.0**-53
_DOT = 8.0 * 2.0**-53
_TINY = 1e-280  # below, products may have underflowed


@subroutine
def turn(a0, a1, b0, b1, c0, c1):
    """Return the sign of the turn a → b → c in the plane: 1 left, −1 right, 0 none, UNSURE within rounding.

    Examples
    --------
    >>> turn(0.0, 0.0, 1.0, 0.0, 0.0, 1.0), turn(0.0, 0.0, 1.0, 0.0, 3.0, 0.0), turn(0.0, 0.0, 0.1, 0.1, 0.3, 0.3)
    (1, 0, 2)
    """
    u, v, w, z = a0 - c0, b1 - c1, a1 - c1, b0 - c0
    left, right = u * v, w * z
    det, magnitude = left - right, abs(left) + abs(right)
    if magnitude > _TINY and abs(det) > _TURN * magnitude:
        return 1 if det > 0.0 else -1
    if (u == 0.0 or v == 0.0) and (w == 0.0 or z == 0.0):
        return 0
    return UNSURE


@subroutine
def _volume(a, b, c, d):
    """Return the sign of the volume of a tetrahedron abcd: 1, −1 or 0, or UNSURE within rounding."""
    u, v, w = a - d, b - d, c - d
    for k in range(3):
        if u[k] == 0.0 and v[k] == 0.0 and w[k] == 0.0:
            return 0
    det, magnitude = 0.0, 0.0
    for k in range(3):
        first_product, second_product = v[(k + 1) % 3] * w[(k + 2) % 3], v[(k + 2) % 3] * w[(k + 1) % 3]
        det += u[k] * (first_product - second_product)
        magnitude += abs(u[k]) * (abs(first_product) + abs(second_product))
    if magnitude > _TINY and abs(det) > _VOLUME * magnitude:
        return 1 if det > 0.0 else -1
    return UNSURE


@kernel
def meet(c, d, a, b):
    """Return whether two closed segments with overlapping boxes meet in the plane: 1, 0 or UNSURE within rounding.

    Examples
    --------
    >>> meet(1, -1, 1, -1), meet(1, 1, 1, -1), meet(0, 0, 0, 0), meet(UNSURE, 1, 1, -1)
    (1, 0, 1, 2)
    """
    if (c == d and abs(c) == 1) or (a == b and abs(a) == 1):
        return 0
    if c == UNSURE or d == UNSURE or a == UNSURE or b == UNSURE:
        return UNSURE
    return 1  # each line is met by the other segment; four points on one line have overlapping boxes


@subroutine
def _overlap(a, b, c, planes):
    """Return whether the links a–b and a–c of one agent run the same way and overlap."""
    is_doubtful = False
    for k in range(planes):
        t = (k + 1) % 3
        sign = turn(a[k], a[t], b[k], b[t], c[k], c[t])
        if abs(sign) == 1:
            return 0
        is_doubtful = is_doubtful or sign == UNSURE
    dot, magnitude, zero = 0.0, 0.0, True
    for k in range(3):
        term = (b[k] - a[k]) * (c[k] - a[k])
        dot += term
        magnitude += abs(term)
        zero = zero and (b[k] == a[k] or c[k] == a[k])
    if zero or (magnitude > _TINY and dot < -_DOT * magnitude):
        return 0
    return 1 if not is_doubtful and magnitude > _TINY and dot > _DOT * magnitude else UNSURE


@subroutine
def cross(x, i, j, g, h, planes):
    """Return whether the links i–j and g–h cross: 1, 0, or UNSURE within rounding.

    Examples
    --------
    >>> x = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    >>> cross(x, 0, 1, 2, 3, 1), cross(x, 0, 2, 1, 3, 1), cross(x, 0, 1, 0, 2, 1)
    (1, 0, 0)
    """
    if i == g:
        return _overlap(x[i], x[j], x[h], planes)
    if i == h:
        return _overlap(x[i], x[j], x[g], planes)
    if j == g:
        return _overlap(x[j], x[i], x[h], planes)
    if j == h:
        return _overlap(x[j], x[i], x[g], planes)
    a, b, c, d = x[i], x[j], x[g], x[h]
    for s in range(3):
        if max(a[s], b[s]) < min(c[s], d[s]) or max(c[s], d[s]) < min(a[s], b[s]):
            return 0
    answer = 1
    for s in range(planes):  # segments that meet in space meet in every projection
        t = (s + 1) % 3
        c_side, d_side = turn(a[s], a[t], b[s], b[t], c[s], c[t]), turn(a[s], a[t], b[s], b[t], d[s], d[t])
        a_side, b_side = turn(c[s], c[t], d[s], d[t], a[s], a[t]), turn(c[s], c[t], d[s], d[t], b[s], b[t])
        meeting = meet(c_side, d_side, a_side, b_side)
        if meeting == 0:
            return 0
        answer = max(answer, meeting)
    if planes == 3:
        sign = _volume(a, b, c, d)
        if abs(sign) == 1:
            return 0
        answer = max(answer, 1 if sign == 0 else UNSURE)
    return answer


@subroutine
def foot(p, a, b):
    """Return the distance of a point from a segment."""
    axial_part, length2 = 0.0, 0.0
    for k in range(3):
        direction = b[k] - a[k]
        axial_part += (p[k] - a[k]) * direction
        length2 += direction * direction
    s = min(1.0, max(0.0, axial_part / length2)) if length2 > 0.0 else 0.0
    squared_distance = 0.0
    for k in range(3):
        offset = p[k] - a[k] - s * (b[k] - a[k])
        squared_distance += offset * offset
    return np.sqrt(squared_distance)


@subroutine
def between(a, b, c, d):
    """Return the distance of two segments that do not cross, at an end or along their common normal."""
    nearest = min(min(foot(a, c, d), foot(b, c, d)), min(foot(c, a, b), foot(d, a, b)))
    uu, uv, vv, uw, vw = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        u, v, w = b[k] - a[k], d[k] - c[k], c[k] - a[k]
        uu, uv, vv, uw, vw = uu + u * u, uv + u * v, vv + v * v, uw + u * w, vw + v * w
    det = uu * vv - uv * uv
    if det > 1e-14 * uu * vv:
        s, t = (uw * vv - uv * vw) / det, (uw * uv - uu * vw) / det
        if 0.0 < s < 1.0 and 0.0 < t < 1.0:
            gap = 0.0
            for k in range(3):
                offset = c[k] - a[k] + t * (d[k] - c[k]) - s * (b[k] - a[k])
                gap += offset * offset
            nearest = min(nearest, np.sqrt(gap))
    return nearest


@kernel
def crossing_signs(x, links, a, b, planes):
    """Return the crossing signs of links a[k] and b[k] for every k: 1, 0 or UNSURE; positions x padded to (n, 3)."""
    signs = np.empty(a.size, np.int64)
    for k in range(a.size):
        signs[k] = cross(x, links[a[k], 0], links[a[k], 1], links[b[k], 0], links[b[k], 1], planes)
    return signs


@kernel
def nearest_links(x, links, a, b, planar, best):
    """Return (least distance below `best` of two links without a common agent, index of the pair, −1 without any)."""
    nearest = -1
    for k in range(a.size):
        i, j, g, h = links[a[k], 0], links[a[k], 1], links[b[k], 0], links[b[k], 1]
        if i in (g, h) or j in (g, h):
            continue
        if planar:  # links that do not cross are nearest at an end of one of them
            foot_distance = min(foot(x[i], x[g], x[h]), foot(x[j], x[g], x[h]))
            link_distance = min(foot_distance, foot(x[g], x[i], x[j]), foot(x[h], x[i], x[j]))
        else:
            link_distance = between(x[i], x[j], x[g], x[h])
        if link_distance < best:
            best, nearest = link_distance, k
    return best, nearest
