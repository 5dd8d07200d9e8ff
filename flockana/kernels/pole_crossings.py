"""Check of a step for skipped poles: distances of infinite potential or undefined force between two agents.

No motion crosses a pole, so a step whose path does is no motion. Paths are the quintics through the ends of the step
(`flockana.kernels.quintic_paths`); those of many agents are not kept, but made again for the few pairs that may matter.
"""

import numpy as np

from flockana.jit import inlined, kernel
from flockana.kernels.encounter_checks import pair_room, relative_curve
from flockana.kernels.quintic_paths import _largest_distance, _least_distance, quintic

_NEAR = 1e-3  # of the way to a pole that is left where a step begins: a path that comes so near has not resolved it


@inlined
def _stage_crosses(curve, edge, inward):
    """Return whether a pair at a Runge-Kutta stage, halfway or at the end, is beyond a distance."""
    for stage in range(3):
        stage_share, curvature_share = (0.5 if stage < 2 else 1.0), (0.0, 0.25, 0.5)[stage]
        start2 = product = way2 = 0.0
        for x in range(3):
            side, curvature = curve[1, x] - curve[0, x], curve[2, x] - 2.0 * curve[1, x] + curve[0, x]
            way = 5.0 * stage_share * side + 20.0 * curvature_share * curvature  # of h p / 5 and h² u / 20
            start2, product, way2 = start2 + curve[0, x] ** 2, product + curve[0, x] * way, way2 + way * way
        share = min(1.0, max(0.0, -product / way2)) if inward and way2 > 0.0 else 1.0
        apart2 = start2 + 2.0 * share * product + share * share * way2
        if (apart2 <= edge * edge) if inward else (apart2 >= edge * edge):
            return True
    return False


@inlined
def _crosses(room, pole, toward):
    """Return whether a pair's path covers the fraction `toward` of its initial distance from a pole."""
    stack = room.stack
    relative_curve(room.points, stack[0])
    begin = np.sqrt(stack[0, 0, 0] ** 2 + stack[0, 0, 1] ** 2 + stack[0, 0, 2] ** 2)
    edge = begin + toward * (pole - begin)
    left = _NEAR * abs(begin - edge)
    if toward < 1.0 and _stage_crosses(stack[0], edge, begin > pole):
        return True
    if begin < pole:
        return _largest_distance(stack, room.spans, edge - left, left)[0] >= edge
    return _least_distance(stack, room.spans, begin, left)[0] <= edge


@kernel
def crossing_listed(ends, ways, poles, toward, first, second):
    """Return whether a listed pair crosses a pole in a step; `ways` are the steepest slope and longest path."""
    h, q0, p0, u0, q1, p1, u1 = ends
    workspace, (steepness, path_reach), m = pair_room(0), ways, q0.shape[1]
    for k in range(first.size):
        i, j = np.int64(first[k]), np.int64(second[k])
        s2 = 0.0
        for c in range(m):
            s2 += (q0[j, c] - q0[i, c]) ** 2
        s = np.sqrt(s2)
        for pole in poles:
            if toward < 1.0 or abs(s - pole) <= steepness * s + 2.0 * path_reach:
                quintic(h, q0[i], p0[i], u0[i], q1[i], p1[i], u1[i], workspace.points[0])
                quintic(h, q0[j], p0[j], u0[j], q1[j], p1[j], u1[j], workspace.points[1])
                if _crosses(workspace, pole, toward):
                    return True
    return False
