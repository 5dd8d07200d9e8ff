"""The pull to a γ-agent whose path is a + bt + c cos ωt + s sin ωt, for integrators that are compiled too.

`numbers` are: whether the energy is that in the moving frame, ℓ of the bounded pull (0 for the linear one), the number
of gains (1, or one per agent), ω, f and then a, b, c, s, e; p_r = f dq_r/dt + e; then c1γ and c2γ.
"""

from __future__ import annotations

from functools import cache
from math import cos, sin, sqrt

import numpy as np

from flockana.kernels.listed import CompiledFunction, term_functions
from flockana.kernels.sums import column_means, pull_to, squared_differences

_MOVING, _UNIT, _GAINS, _OMEGA, _FACTOR, _PATH = range(6)


def act(t, x, v, u, frame, numbers, panels, first, second, size, order):
    """−c1γ ℓ σ₁((q − q_r)/ℓ) − c2γ (p − p_r), and its power."""
    n, m = x.shape
    omega, factor, unit = numbers[_OMEGA], numbers[_FACTOR], numbers[_UNIT]
    gains, path = np.int64(numbers[_GAINS]), numbers[_PATH : _PATH + 5 * m].reshape(5, m)
    c1, c2 = numbers[_PATH + 5 * m :][:gains], numbers[_PATH + 5 * m + gains :]
    co, si = cos(omega * t), sin(omega * t)
    q_r, p_r, rate = np.empty(m), np.empty(m), np.empty(m)
    for k in range(m):
        rate[k] = path[1, k] + omega * (path[3, k] * co - path[2, k] * si)
        q_r[k] = path[0, k] + path[1, k] * t + path[2, k] * co + path[3, k] * si - frame[0, k]
        p_r[k] = factor * rate[k] + path[4, k] - frame[1, k]
    if numbers[_MOVING] != 0.0:
        pull_to(u, x, v, q_r, p_r, c1[0], c2[0])
        return -c2[0] * squared_differences(v, column_means(v))
    power = 0.0
    for i in range(n):
        own = np.int64(order[i]) if gains > 1 else 0
        bend = 1.0
        if unit > 0.0:
            square = 0.0
            for k in range(m):
                square += (x[i, k] - q_r[k]) ** 2
            bend = sqrt(1.0 + square / (unit * unit))
        for k in range(m):
            pull, slip = c1[own] * (x[i, k] - q_r[k]) / bend, v[i, k] - p_r[k]
            u[i, k] -= pull + c2[own] * slip
            power -= c2[own] * (v[i, k] + frame[1, k]) * slip + pull * rate[k]
    return power


def energy(t, x, v, frame, numbers, panels, first, second, size, order):
    """½ c1γ Σ‖x_i‖² in the moving frame, or Σ c1γ_i ℓ² (√(1 + ‖q_i − q_r‖²/ℓ²) − 1)."""
    n, m = x.shape
    omega, unit = numbers[_OMEGA], numbers[_UNIT]
    gains, path = np.int64(numbers[_GAINS]), numbers[_PATH : _PATH + 5 * m].reshape(5, m)
    c1, total = numbers[_PATH + 5 * m :][:gains], 0.0
    if numbers[_MOVING] != 0.0:
        return 0.5 * c1[0] * squared_differences(x, column_means(x))
    q_r = np.empty(m)
    for k in range(m):
        turn = path[2, k] * cos(omega * t) + path[3, k] * sin(omega * t)
        q_r[k] = path[0, k] + path[1, k] * t + turn - frame[0, k]
    for i in range(n):
        square = 0.0
        for k in range(m):
            square += (x[i, k] - q_r[k]) ** 2
        bend = sqrt(1.0 + square / (unit * unit)) if unit > 0.0 else 1.0
        total += c1[np.int64(order[i]) if gains > 1 else 0] * square / (bend + 1.0)
    return total


@cache
def compiled() -> tuple[CompiledFunction, CompiledFunction]:
    """Force and energy, compiled when first asked for."""
    return term_functions(act, energy)
