"""Dense samples of a run, for smooth curves between the solver's steps."""

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.laws import DiscreteLaw

_INSTANTS = 1500  # about as many as a figure has pixels across


def velocities_between(trajectory: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Return times and velocities within the solver's steps, by cubics through velocities and accelerations."""
    ensure_run(trajectory)
    t, _, p, u, _ = trajectory.path
    parts = -(-_INSTANTS // max(1, len(t) - 1))
    if isinstance(trajectory.law, DiscreteLaw) or len(t) < 2 or parts == 1:
        return t, p
    x, h = np.arange(parts)[:, None, None, None] / parts, np.diff(t)[:, None, None]  # on all steps at once
    straight = p[:-1] + x**2 * (3.0 - 2.0 * x) * (p[1:] - p[:-1])
    inner = straight + x * (1.0 - x) * h * ((1.0 - x) * u[:-1] - x * u[1:])
    times = t[:-1] + x[:, :, 0, 0] * np.diff(t)
    return np.append(times.T.ravel(), t[-1]), np.concatenate([inner.swapaxes(0, 1).reshape(-1, *p.shape[1:]), p[-1:]])
