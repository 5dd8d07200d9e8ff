"""Dense samples of a run, for smooth curves between the solver's steps."""

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from flockana.base.checks import FloatArray
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory

_INSTANTS = 1500  # about as many as a figure has pixels across


def velocities_between(trajectory: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Return times and velocities within the solver's steps, by cubics through velocities and accelerations."""
    ensure_run(trajectory)
    t, _, p, u, _ = trajectory.path
    parts = -(-_INSTANTS // max(1, len(t) - 1))
    if trajectory.law.is_map or len(t) < 2 or parts == 1:
        return t, p
    times = (t[:-1, None] + np.diff(t)[:, None] * np.arange(parts) / parts).ravel()
    return np.append(times, t[-1]), np.concatenate([CubicHermiteSpline(t, p, u)(times), p[-1:]])
