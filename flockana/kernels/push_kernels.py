"""Constant and sinusoidal push on the agents, for compiled integrators.

`numbers` are: whether the energy is that in the moving frame, ω, the number of rows (1, or one per agent), and then
the rows of the constant part, of the amplitudes of cos ωt and of those of sin ωt.
"""

from math import cos, sin
from typing import Any

import numpy as np

from flockana.jit import kernel

_MOVING, _OMEGA, _ROWS, _FIRST = range(4)


def numbers(moving: bool, constant: Any, cosine: Any, sine: Any, omega: float) -> Any:
    """Return the kernel parameters of a push."""
    head = [float(moving), omega, float(len(constant))]
    return np.concatenate([head, np.ravel(constant), np.ravel(cosine), np.ravel(sine)])


@kernel
def act(t, x, v, u, numbers, panels, listed):
    """Add a constant and a sinusoidal push to the agents' accelerations u, and return its power."""
    (n, m), rows, power = x.shape, np.int64(numbers[_ROWS]), 0.0
    co, si, block_size = cos(numbers[_OMEGA] * t), sin(numbers[_OMEGA] * t), rows * m
    for k in range(m):
        centre = 0.0
        if numbers[_MOVING] != 0.0:
            for i in range(n):
                centre += v[i, k] / n
        else:
            centre = -listed.frame[1, k]
        for i in range(n):
            at = _FIRST + (np.int64(listed.order[i]) if rows > 1 else 0) * m + k
            push = numbers[at] + co * numbers[at + block_size] + si * numbers[at + 2 * block_size]
            u[i, k] += push
            power += push * (v[i, k] - centre)
    return power
