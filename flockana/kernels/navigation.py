"""The pull to a γ-agent whose path is a + bt + c cos ωt + s sin ωt, for compiled integrators.

`numbers` are: whether the energy is that in the moving frame, ℓ of the bounded pull (0 for the linear one), the number
of gains (1, or one per agent), ω, f and then a, b, c, s, e; p_r = f dq_r/dt + e; then c1γ and c2γ.
"""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np

from flockana.jit import njit, register_jitable
from flockana.kernels.sums import pull_to, squared_deviations

_MOVING, _UNIT, _GAINS, _OMEGA, _FACTOR, _PATH = range(6)


@njit(cache=True, error_model="numpy", nogil=True)
def navigate(x, v, u, target, velocity, gains, unit, moving, order):
    """Add −c1γ ℓ σ₁((q − q_r)/ℓ) − c2γ (p − p_r) to u, and return its power.

    The rows of `target` are q_r and p_r, seen from a frame as x and v are, and the true dq_r/dt; `velocity` is that of
    the frame. `gains` are c1γ and c2γ, one each or one per agent, whose own number `order` has. ℓ = 0 is the linear
    pull.
    """
    (n, m), (c1, c2), power = x.shape, gains, 0.0
    if moving:
        pull_to(u, x, v, target[0], target[1], c1[0], c2[0])
        return -c2[0] * squared_deviations(v)
    for i in range(n):
        own = np.int64(order[i]) if c1.size > 1 else 0
        bend = 1.0
        if unit > 0.0:
            square = 0.0
            for k in range(m):
                square += (x[i, k] - target[0, k]) ** 2
            bend = sqrt(1.0 + square / (unit * unit))
        for k in range(m):
            pull, slip = c1[own] * (x[i, k] - target[0, k]) / bend, v[i, k] - target[1, k]
            u[i, k] -= pull + c2[own] * slip
            power -= c2[own] * (v[i, k] + velocity[k]) * slip + pull * target[2, k]
    return power


@register_jitable
def _place(t, co, si, path, k):
    """Coordinate k of the path, from the cosine and sine of ωt."""
    return path[0, k] + path[1, k] * t + path[2, k] * co + path[3, k] * si


@njit(cache=True, error_model="numpy", nogil=True)
def _follow(t, x, v, u, frame, numbers, order, target):
    """`navigate` to the path that the numbers describe; `target` is room for it, three rows of m numbers or more."""
    m, omega, gains = x.shape[1], numbers[_OMEGA], np.int64(numbers[_GAINS])
    path, c = numbers[_PATH : _PATH + 5 * m].reshape(5, m), numbers[_PATH + 5 * m :]
    co, si = cos(omega * t), sin(omega * t)
    for k in range(m):
        rate = path[1, k] + omega * (path[3, k] * co - path[2, k] * si)
        target[0, k] = _place(t, co, si, path, k) - frame[0, k]
        target[1, k], target[2, k] = numbers[_FACTOR] * rate + path[4, k] - frame[1, k], rate
    return navigate(x, v, u, target, frame[1], (c[:gains], c[gains:]), numbers[_UNIT], numbers[_MOVING] != 0.0, order)


@njit(cache=True, error_model="numpy")
def follow(t, x, v, u, numbers):
    """`navigate` to the path that the numbers describe, seen from where it is at rest and in the agents' own order."""
    (n, m), gains = x.shape, numbers[_GAINS]
    order = np.arange(n if gains > 1.0 else 0).astype(np.uint64)
    return _follow(t, x, v, u, np.zeros((2, m)), numbers, order, np.empty((3, m)))


@njit(cache=True, error_model="numpy", nogil=True)
def act(t, x, v, u, numbers, panels, listed):
    """`follow` as a term of a law."""
    return _follow(t, x, v, u, listed.frame, numbers, listed.order, listed.room)


@njit(cache=True, error_model="numpy", nogil=True)
def energy(t, x, v, numbers, panels, listed):
    """½ c1γ Σ‖x_i‖² in the moving frame, or Σ c1γ_i ℓ² (√(1 + ‖q_i − q_r‖²/ℓ²) − 1)."""
    (n, m), unit, gains = x.shape, numbers[_UNIT], numbers[_GAINS]
    path, c1, total = numbers[_PATH : _PATH + 5 * m].reshape(5, m), numbers[_PATH + 5 * m :], 0.0
    if numbers[_MOVING] != 0.0:
        return 0.5 * c1[0] * squared_deviations(x)
    co, si = cos(numbers[_OMEGA] * t), sin(numbers[_OMEGA] * t)
    for i in range(n):
        square = 0.0
        for k in range(m):
            square += (x[i, k] - (_place(t, co, si, path, k) - listed.frame[0, k])) ** 2
        bend = sqrt(1.0 + square / (unit * unit)) if unit > 0.0 else 1.0
        total += c1[np.int64(listed.order[i]) if gains > 1.0 else 0] * square / (bend + 1.0)
    return total
