"""Terms of single agents for compiled integrators: drag and thrust, a common acceleration.

They have no potential energy. `numbers` begin with whether the law's energy is that in the moving frame, where a push
on all agents alike does no work and a drag works on the differences of velocity alone.
"""

from math import cos, sin

from flockana.jit import kernel
from flockana.kernels.agent_sums import column_mean, column_squares

_MOVING, _THRUST, _BRAKE = range(3)
_OMEGA, _PATH = 1, 2


@kernel
def act_along(t, x, v, u, numbers, panels, listed):
    """Add drag and thrust, (thrust − brake ‖p_i‖²) p_i, to the accelerations u, and return their power."""
    (n, m), velocity, centre, thrust_gain, brake_gain, power = (
        v.shape, listed.frame[1], listed.room[0], numbers[_THRUST], numbers[_BRAKE], 0.0,
    )  # fmt: skip
    for k in range(m):
        centre[k] = column_mean(v, k) if numbers[_MOVING] != 0.0 else -velocity[k]
    for i in range(n):
        squared_value = 0.0
        for k in range(m):
            squared_value += (v[i, k] + velocity[k]) ** 2
        factor = thrust_gain - brake_gain * squared_value
        for k in range(m):
            push = factor * (v[i, k] + velocity[k])
            u[i, k] += push
            power += push * (v[i, k] - centre[k])
    if brake_gain == 0.0:  # a drag alone: squares, of which none cancels
        power = 0.0
        for k in range(m):
            power += thrust_gain * column_squares(v, k, centre[k])
    return power


@kernel
def act_all(t, x, v, u, numbers, panels, listed):
    """Add the γ-agent's acceleration d²q_r/dt² to all u_i; return its power, 0 in the moving frame."""
    (n, m), omega, power = x.shape, numbers[_OMEGA], 0.0
    path = numbers[_PATH : _PATH + 5 * m].reshape(5, m)
    for k in range(m):
        push = -omega * omega * (path[2, k] * cos(omega * t) + path[3, k] * sin(omega * t))
        for i in range(n):
            u[i, k] += push
            power += push * (v[i, k] + listed.frame[1, k])
    return 0.0 if numbers[_MOVING] != 0.0 else power
