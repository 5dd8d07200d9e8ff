"""Check of a step for skipped obstacles: an agent in and out of reach between two evaluations.

The paths of a step are the quintics through its ends, given by their control points (`flockana.kernels.quintic_paths`).
"""

import numpy as np

from flockana.jit import kernel, register_jitable

MARCHES = 60  # towards an obstacle, each as far as it is away
TOUCH = 1e-6  # of the range: so near counts as in range
LOOKS = 16  # along the way within an obstacle's range, for the closest approach


@register_jitable
def out_of_reach(q, i, balls, k, reach):
    """Return whether point i is farther than `reach` from ball k (centre, radius)."""
    s2, m = 0.0, balls.shape[1] - 1
    for c in range(m):
        s2 += (q[i, c] - balls[k, c]) ** 2
    return s2 > (balls[k, m] + reach) ** 2


@register_jitable
def within_reach(q, balls, k, reach, s2, near):
    """Write the indices of points within `reach` of ball k, or NaN, in rising order; return their number."""
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


@kernel
def point_at(curve, s, out):
    """Write the point of a Bézier curve (degree + 1, 3) at s into the first components of `out`."""
    degree, b = len(curve) - 1, np.empty(len(curve))
    for c in range(out.size):
        for k in range(degree + 1):
            b[k] = curve[k, c]
        for level in range(degree):
            for k in range(degree - level):
                b[k] += s * (b[k + 1] - b[k])
        out[c] = b[0]


@kernel
def longest(vectors):
    """Return the largest length of some vectors."""
    s2 = 0.0
    for k in range(len(vectors)):
        s2 = max(s2, vectors[k, 0] ** 2 + vectors[k, 1] ** 2 + vectors[k, 2] ** 2)
    return np.sqrt(s2)
