"""Terms of single agents for compiled integrators: drag and thrust, a common acceleration.

They have no potential energy. `numbers` begin with whether the law's energy is that in the moving frame, where a push
on all agents alike does no work and a drag works on the differences of velocity alone.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np

from flockana.jit import kernel
from flockana.kernels.sums import column_mean, column_squares

_MOVING, _THRUST, _BRAKE = range(3)
_OMEGA, _PATH = 1, 2


@kernel
def _push_along(v, u, velocity, thrust, brake, moving, centre):
    """`push_along`; `centre` is room for m numbers."""
    (n, m), power = v.shape, 0.0
    for k in range(m):
        centre[k] = column_mean(v, k) if moving else -velocity[k]
    for i in range(n):
        square = 0.0
        for k in range(m):
            square += (v[i, k] + velocity[k]) ** 2
        factor = thrust - brake * square
        for k in range(m):
            push = factor * (v[i, k] + velocity[k])
            u[i, k] += push
            power += push * (v[i, k] - centre[k])
    if brake == 0.0:  # a drag alone: squares, of which none cancels
        power = 0.0
        for k in range(m):
            power += thrust * column_squares(v, k, centre[k])
    return power


@kernel
def push_along(v, u, velocity, thrust, brake, moving):
    """Add (thrust − brake ‖p_i‖²) p_i to u, and return its power; `velocity` is that of the frame v is seen from."""
    return _push_along(v, u, velocity, thrust, brake, moving, np.empty(v.shape[1]))


@kernel
def push_all(v, u, velocity, push, moving):
    """Add one acceleration to all, and return its power: 0 in the moving frame."""
    (n, m), power = v.shape, 0.0
    for i in range(n):
        for k in range(m):
            u[i, k] += push[k]
            power += push[k] * (v[i, k] + velocity[k])
    return 0.0 if moving else power


@kernel
def act_along(t, x, v, u, numbers, panels, listed):
    """`push_along` as a term of a law."""
    moving, room = numbers[_MOVING] != 0.0, listed.room[0]
    return _push_along(v, u, listed.frame[1], numbers[_THRUST], numbers[_BRAKE], moving, room)


@kernel
def act_all(t, x, v, u, numbers, panels, listed):
    """`push_all` as a term of a law."""
    m, omega = x.shape[1], numbers[_OMEGA]
    path, push = numbers[_PATH : _PATH + 5 * m].reshape(5, m), listed.room[0]
    for k in range(m):
        push[k] = -omega * omega * (path[2, k] * cos(omega * t) + path[3, k] * sin(omega * t))
    return push_all(v, u, listed.frame[1], push, numbers[_MOVING] != 0.0)
