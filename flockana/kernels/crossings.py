"""Which of some pairs of links cross, and how near the nearest two come."""

import numpy as np

from flockana.jit import kernel
from flockana.kernels.segments import between, cross, foot


@kernel
def crossing_signs(x, links, a, b, planes):
    """`cross` of links a[k] and b[k] for every k: 1, 0 or UNSURE; positions x are padded to (n, 3)."""
    signs = np.empty(a.size, np.int64)
    for k in range(a.size):
        signs[k] = cross(x, links[a[k], 0], links[a[k], 1], links[b[k], 0], links[b[k], 1], planes)
    return signs


@kernel
def nearest_links(x, links, a, b, planar, best):
    """(least distance below `best` of two links without a common agent, index of the pair, −1 without any)."""
    nearest = -1
    for k in range(a.size):
        i, j, g, h = links[a[k], 0], links[a[k], 1], links[b[k], 0], links[b[k], 1]
        if i in (g, h) or j in (g, h):
            continue
        if planar:  # links that do not cross are nearest at an end of one of them
            far = min(foot(x[i], x[g], x[h]), foot(x[j], x[g], x[h]))
            here = min(far, foot(x[g], x[i], x[j]), foot(x[h], x[i], x[j]))
        else:
            here = between(x[i], x[j], x[g], x[h])
        if here < best:
            best, nearest = here, k
    return best, nearest
