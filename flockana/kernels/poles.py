"""Whether a step leapt over a pole: a distance at which two agents' potential is infinite or their force undefined.

No motion crosses one, so a step whose path does is no motion. Paths are the quintics through the ends of the step
(`flockana.kernels.paths`); those of many agents are not kept, but made again for the few pairs that may matter.
"""

from __future__ import annotations

import numpy as np

from flockana.jit import njit
from flockana.kernels.encounters import _load
from flockana.kernels.paths import _DEPTH, _largest_distance, _least_distance, quintic

_NEAR = 1e-3  # of the way to a pole that is left where a step begins: a path that comes so near has not resolved it


@njit(cache=True, error_model="numpy")
def _crosses(points, i, j, pole, stack, spans):
    """Whether a pair's path reaches the pole, from the side on which it begins."""
    _load(points, i, j, stack[0])
    begin = np.sqrt(stack[0, 0, 0] ** 2 + stack[0, 0, 1] ** 2 + stack[0, 0, 2] ** 2)
    left = _NEAR * abs(begin - pole)
    if begin < pole:
        return _largest_distance(stack, spans, pole - left, left)[0] >= pole
    return _least_distance(stack, spans, begin, left)[0] <= pole


@njit(cache=True, error_model="numpy", nogil=True)
def crossing(points, reach, poles, first, second):
    """Whether a pair crosses a pole in a step with these control points, of reaches that they do not leave."""
    stack, spans = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2))
    for k in range(first.size):
        i, j = np.int64(first[k]), np.int64(second[k])
        s2 = 0.0
        for x in range(3):
            s2 += (points[j, 0, x] - points[i, 0, x]) ** 2
        s, way = np.sqrt(s2), reach[i] + reach[j]
        for pole in poles:
            if abs(s - pole) <= way and _crosses(points, i, j, pole, stack, spans):
                return True
    return False


@njit(cache=True, error_model="numpy", nogil=True)
def crossing_listed(h, ends, ways, poles, first, second):
    """As `crossing`, of listed pairs between two states; `ways` are (steepest slope, longest way beside it) of all."""
    q0, p0, u0, q1, p1, u1 = ends
    stack, spans = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2))
    points, (steep, way), m = np.zeros((2, 6, 3)), ways, q0.shape[1]
    for k in range(first.size):
        i, j = np.int64(first[k]), np.int64(second[k])
        s2 = 0.0
        for c in range(m):
            s2 += (q0[j, c] - q0[i, c]) ** 2
        s = np.sqrt(s2)
        for pole in poles:
            if abs(s - pole) <= steep * s + 2.0 * way:
                quintic(h, q0[i], p0[i], u0[i], q1[i], p1[i], u1[i], points[0])
                quintic(h, q0[j], p0[j], u0[j], q1[j], p1[j], u1[j], points[1])
                if _crosses(points, 0, 1, pole, stack, spans):
                    return True
    return False
