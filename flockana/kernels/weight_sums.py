"""Velocity consensus with any weight of the distance: a template (`flockana.kernels.bound_templates`).

A weight is a scalar function of the squared distance and of its parameters. The numbers of a term are the gain, whether
it is divided by the number of agents, the range (infinite for all pairs) and the parameters.
"""

import numpy as np

from flockana.jit import kernel, register_jitable
from flockana.kernels.alignment import rational as weight  # bound


@register_jitable
def _exchange(i, j, x, v, gain, r2, par, u):
    s2, slip2 = 0.0, 0.0
    for c in range(x.shape[1]):
        s2 += (x[j, c] - x[i, c]) ** 2
    if s2 >= r2:
        return 0.0
    a = weight(s2, par)
    for c in range(x.shape[1]):
        velocity_difference = v[j, c] - v[i, c]
        u[i, c] += gain * a * velocity_difference
        u[j, c] -= gain * a * velocity_difference
        slip2 += velocity_difference * velocity_difference
    return a * slip2


@kernel
def match(x, v, gain, r2, par, u):
    """Add gain Σ a (v_j − v_i) over the pairs nearer than √r2; return the dissipation Σ a ‖v_j − v_i‖²."""
    total = 0.0
    for i in range(len(x)):
        for j in range(i + 1, len(x)):
            total += _exchange(i, j, x, v, gain, r2, par, u)
    return total


@kernel
def act(t, x, v, u, numbers, panels, listed):
    """Add velocity consensus as a term of a law, over all or listed pairs, and return its power."""
    gain, r2, par = numbers[0], numbers[2] * numbers[2], numbers[3:]
    if numbers[1] != 0.0:
        gain /= len(x)
    if np.isinf(r2):
        return -gain * match(x, v, gain, r2, par, u)
    total = 0.0
    for k in range(listed.count):
        total += _exchange(np.int64(listed.first[k]), np.int64(listed.second[k]), x, v, gain, r2, par, u)
    return -gain * total
