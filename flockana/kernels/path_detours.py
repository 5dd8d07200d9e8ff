"""Distance between the path of a long step and the paths through a middle state, the error of omitting a step.

Both are quintics (`flockana.kernels.quintic_paths`). The long one is parted at the middle by de Casteljau; the
difference of two curves stays in the hull of the differences of their control points.
"""

import numpy as np

from flockana.jit import kernel, register_jitable
from flockana.kernels.quintic_paths import polygon


@register_jitable
def _parted(points, share):
    """Return the control points of a curve up to the parameter `share`, and those of the remainder."""
    a0, a1, a2, a3, a4, a5 = points
    b0, b1, b2 = a0 + share * (a1 - a0), a1 + share * (a2 - a1), a2 + share * (a3 - a2)
    b3, b4 = a3 + share * (a4 - a3), a4 + share * (a5 - a4)
    c0, c1, c2, c3 = b0 + share * (b1 - b0), b1 + share * (b2 - b1), b2 + share * (b3 - b2), b3 + share * (b4 - b3)
    d0, d1, d2 = c0 + share * (c1 - c0), c1 + share * (c2 - c1), c2 + share * (c3 - c2)
    e0, e1 = d0 + share * (d1 - d0), d1 + share * (d2 - d1)
    f0 = e0 + share * (e1 - e0)
    return (a0, b0, c0, d0, e0, f0), (f0, e1, d2, c3, b4, a5)


@kernel
def detours(times, first, middle, last, slack0, slack1):
    """Return each agent's largest path deviation between the direct step and the path through the middle state.

    The parts of the path through the middle have slacks.
    """
    (t0, t1, t2), (q0, p0, u0), (q1, p1, u1), (q2, p2, u2) = times, first, middle, last
    (n, m), share, farthest = q0.shape, (t1 - t0) / (t2 - t0), np.empty(q0.shape[0])
    s, s0, s1 = (t2 - t0) / 5.0, (t1 - t0) / 5.0, (t2 - t1) / 5.0
    z, z0, z1 = (t2 - t0) ** 2 / 20.0, (t1 - t0) ** 2 / 20.0, (t2 - t1) ** 2 / 20.0
    for i in range(n):
        d1 = d2 = d3 = d4 = d5 = 0.0
        for c in range(m):
            direct_polygon = polygon(q0[i, c], q2[i, c], s * p0[i, c], s * p2[i, c], z * u0[i, c], z * u2[i, c])
            left, right = _parted(direct_polygon, share)
            first_polygon = polygon(q0[i, c], q1[i, c], s0 * p0[i, c], s0 * p1[i, c], z0 * u0[i, c], z0 * u1[i, c])
            next_polygon = polygon(q1[i, c], q2[i, c], s1 * p1[i, c], s1 * p2[i, c], z1 * u1[i, c], z1 * u2[i, c])
            d1 += (left[3] - first_polygon[3]) ** 2  # the first three are the same: both paths begin alike
            d2 += (left[4] - first_polygon[4]) ** 2
            d3 += (left[5] - first_polygon[5]) ** 2  # where the parts meet
            d4 += (right[1] - next_polygon[1]) ** 2
            d5 += (right[2] - next_polygon[2]) ** 2  # the last three are the same
        first_detour, second_detour = np.sqrt(max(max(d1, d2), d3)), np.sqrt(max(max(d4, d5), d3))
        farthest[i] = max(first_detour + slack0[i], second_detour + slack1[i])
    return farthest
