"""Runs shared by several errata of the dead-zone paper."""

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking


def parting_pair() -> tuple[DeadZoneFlocking, FloatArray, FloatArray]:
    """Return law, positions and velocities of two agents 14 m apart that separate at 12 m/s."""
    return DeadZoneFlocking(), np.array([[0.0, 0.0], [14.0, 0.0]]), np.array([[-6.0, 0.0], [6.0, 0.0]])


def advance(
    law: DeadZoneFlocking, q: FloatArray, p: FloatArray, dt: float, t_end: float
) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities at t_end by semi-implicit Euler steps."""
    for _ in range(round(t_end / (500 * dt))):
        states = law.semi_implicit(q, p, dt, 500, np.array([500]))
        q, p = states[0][-1], states[1][-1]
    return q, p
