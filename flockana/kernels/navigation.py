"""Pull to a γ-agent with the path a + bt + c cos ωt + s sin ωt, for compiled integrators.

`numbers` are: whether the energy is that in the moving frame, ℓ of the bounded pull (0 for the linear one), the number
of gains (1, or one per agent), ω, f and then a, b, c, s, e; p_r = f dq_r/dt + e; then c1γ and c2γ.
"""

from math import cos, sin, sqrt

import numpy as np

from flockana.jit import inlined, kernel
from flockana.kernels.agent_sums import pull_to, squared_deviations

_MOVING, _UNIT, _GAINS, _OMEGA, _FACTOR, _PATH = range(6)


@inlined
def _place(t, co, si, path, k):
    """Return coordinate k of the γ-agent's path at a time, from the cosine and sine of ωt."""
    return path[0, k] + path[1, k] * t + path[2, k] * co + path[3, k] * si


@kernel
def act(t, x, v, u, numbers, panels, listed):
    """Add −c1γ ℓ σ₁((q − q_r)/ℓ) − c2γ (p − p_r) to u, and return its power; ℓ = 0 is the linear pull."""
    (n, m), omega, gains, frame, target = x.shape, numbers[_OMEGA], np.int64(numbers[_GAINS]), listed.frame, listed.room
    path, c1 = numbers[_PATH : _PATH + 5 * m].reshape(5, m), numbers[_PATH + 5 * m :]
    c2, co, si, unit, power = c1[gains:], cos(omega * t), sin(omega * t), numbers[_UNIT], 0.0
    for k in range(m):  # q_r and p_r, seen from the frame as x and v are, and the true dq_r/dt
        rate = path[1, k] + omega * (path[3, k] * co - path[2, k] * si)
        target[0, k] = _place(t, co, si, path, k) - frame[0, k]
        target[1, k], target[2, k] = numbers[_FACTOR] * rate + path[4, k] - frame[1, k], rate
    if numbers[_MOVING] != 0.0:
        pull_to(u, x, v, target[0], target[1], c1[0], c2[0])
        return -c2[0] * squared_deviations(v)
    for i in range(n):
        agent = np.int64(listed.order[i]) if gains > 1 else 0
        saturation = 1.0
        if unit > 0.0:
            squared_value = 0.0
            for k in range(m):
                squared_value += (x[i, k] - target[0, k]) ** 2
            saturation = sqrt(1.0 + squared_value / (unit * unit))
        for k in range(m):
            pull, velocity_difference = c1[agent] * (x[i, k] - target[0, k]) / saturation, v[i, k] - target[1, k]
            u[i, k] -= pull + c2[agent] * velocity_difference
            power -= c2[agent] * (v[i, k] + frame[1, k]) * velocity_difference + pull * target[2, k]
    return power


@kernel
def energy(t, x, v, numbers, panels, listed):
    """Return ½ c1γ Σ‖x_i‖² in the moving frame, or Σ c1γ_i ℓ² (√(1 + ‖q_i − q_r‖²/ℓ²) − 1) of the bounded pull."""
    (n, m), unit, gains = x.shape, numbers[_UNIT], numbers[_GAINS]
    path, c1, total = numbers[_PATH : _PATH + 5 * m].reshape(5, m), numbers[_PATH + 5 * m :], 0.0
    if numbers[_MOVING] != 0.0:
        return 0.5 * c1[0] * squared_deviations(x)
    co, si = cos(numbers[_OMEGA] * t), sin(numbers[_OMEGA] * t)
    for i in range(n):
        squared_value = 0.0
        for k in range(m):
            squared_value += (x[i, k] - (_place(t, co, si, path, k) - listed.frame[0, k])) ** 2
        saturation = sqrt(1.0 + squared_value / (unit * unit)) if unit > 0.0 else 1.0
        total += c1[np.int64(listed.order[i]) if gains > 1.0 else 0] * squared_value / (saturation + 1.0)
    return total
