"""Whether a step leapt over an obstacle: an agent in and out of its reach between two evaluations.

The paths of a step are the quintics through its ends, given by their control points (`flockana.kernels.paths`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.encounters import SLACK
from flockana.kernels.paths import reach_of

_MARCHES = 60  # towards an obstacle, each as far as it is away
_TOUCH = 1e-6  # of the range: so near counts as in range
_LOOKS = 16  # along the way within an obstacle's range, for the closest approach


@register_jitable
def out_of_reach(q, i, balls, k, reach):
    """Whether point i is farther than `reach` from ball k (centre, radius)."""
    s2, m = 0.0, balls.shape[1] - 1
    for c in range(m):
        s2 += (q[i, c] - balls[k, c]) ** 2
    return s2 > (balls[k, m] + reach) ** 2


@register_jitable
def within_reach(q, balls, k, reach, s2, near):
    """Write which points are within `reach` of ball k (and which are nowhere: NaN), in rising order; how many."""
    (n, m), count = q.shape, 0
    for c in range(m):
        x = balls[k, c]
        for i in range(n):
            s2[i] = (s2[i] if c > 0 else 0.0) + (q[i, c] - x) ** 2
    limit = (balls[k, m] + reach) ** 2
    for i in range(n):
        near[count] = i
        count += not s2[i] > limit
    return count


@njit(cache=True, error_model="numpy", nogil=True)
def _point(curve, s, out):
    """Write the point of a Bézier curve (degree + 1, 3) at s into the first components of `out`."""
    degree, b = len(curve) - 1, np.empty(len(curve))
    for c in range(out.size):
        for k in range(degree + 1):
            b[k] = curve[k, c]
        for level in range(degree):
            for k in range(degree - level):
                b[k] += s * (b[k + 1] - b[k])
        out[c] = b[0]


@njit(cache=True, error_model="numpy", nogil=True)
def _longest(vectors):
    """The largest length of some vectors."""
    s2 = 0.0
    for k in range(len(vectors)):
        s2 = max(s2, vectors[k, 0] ** 2 + vectors[k, 1] ** 2 + vectors[k, 2] ** 2)
    return np.sqrt(s2)


def lift_shells(project: Callable[..., float], digest: int) -> Callable[..., float]:
    """Compile the look at obstacles of one kind, given by its closest-point map.

    The function, ``share(points, allowance, pars, starts, balls, shell, far, share)``, returns the share of the step,
    at most the one given, within which no agent on a path with these control points (n, 6, 3) leaps over the distance
    `shell` from an obstacle, or goes farther than `far` within it.
    """

    @register_jitable
    def distance(q, par, room):
        return abs(project(q, room[0], par, room[1], room[2]) + 0.0 * digest)

    @njit(cache=True, error_model="numpy", nogil=True)
    def visit(curve, edge, far, par, here, room):
        # The distance from an obstacle changes by no more than the way: so far beyond the edge may be gone safely.
        legs = 5.0 * (curve[1:] - curve[:-1])
        fastest, s = _longest(legs), 0.0
        if fastest == 0.0:
            return 1.0
        for _ in range(_MARCHES):
            _point(curve, s, here)
            gap = distance(here, par, room) - edge
            if gap <= _TOUCH * edge:
                break
            s += gap / fastest
            if s >= 1.0:
                return 1.0
        rate = np.zeros((1, 3))
        _point(legs, s, rate[0, : here.size])
        speed = _longest(rate)
        last = min(1.0, s + far / speed) if speed > 0.0 else 1.0
        stop, least = s, np.inf
        for k in range(_LOOKS):
            look = s + (last - s) * k / (_LOOKS - 1)
            _point(curve, look, here)
            away = distance(here, par, room)
            if away < least:
                stop, least = look, away
        return 1.0 if s + SLACK * (stop - s) >= 1.0 or stop <= s else stop

    @njit(cache=True, error_model="numpy", nogil=True)
    def share_of_bodies(points, allowance, pars, starts, balls, shell, far, share):
        m = balls.shape[1] - 1
        here, room = np.empty(m), np.zeros((3, m))  # a place, and for the projection: rest, gap and rate
        begin, end = points[:, 0], points[:, 5]
        for i in range(points.shape[0]):
            way, edge = reach_of(points[i]), shell + allowance[i]
            reach = way + allowance[i]
            for k in range(balls.shape[0]):
                if out_of_reach(begin, i, balls, k, shell + reach):
                    continue
                for c in range(m):
                    here[c] = begin[i, c]
                par = pars[starts[k] : starts[k + 1]]
                beyond = distance(here, par, room) - edge
                if beyond < 0.0:
                    if way > SLACK * far:
                        share = min(share, far / way)
                    continue
                if beyond >= reach:
                    continue
                for c in range(m):
                    here[c] = end[i, c]
                if way <= far and distance(here, par, room) < edge:
                    continue  # the evaluation at the end of the step meets it
                share = min(share, visit(points[i], edge, far, par, here, room))
        return share

    return share_of_bodies
