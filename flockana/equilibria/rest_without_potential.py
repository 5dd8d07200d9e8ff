"""Resting states of laws without a potential, by Newton's method on forces or velocities."""

from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, SolverError
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_points
from flockana.laws import Law, ensure_law
from flockana.laws.first_order_law import VelocityLaw

_STEPS = 40
_RANK = 1e-10  # of the largest singular value: what is less is a direction in which nothing pushes
_CONVERGED = 1e-12  # of the stiffness times the flock's size
_SHORTEN = 0.5  # factor on a step, as often as the force grows by it


def resting_state(law: Any, q0: Any, *, t: float = 0.0) -> FloatArray:
    """Return positions near q0 where all forces on resting agents, or all velocities, vanish (Newton)."""
    # Where a law has a potential `find_equilibrium` says more: which kind of equilibrium it is.
    first_order = isinstance(law, VelocityLaw)
    if not first_order and not isinstance(ensure_law(law), Law):
        raise ArgumentError(f"expected a continuous law, as a map has no forces at rest: got {type(law).__name__}")
    q, t = ensure_points("q0", q0), ensure_finite_scalar("t", t)
    law.check_dimension(q.shape[1])
    if first_order:
        law.start(t, q)
    else:
        law.check_start(q, np.zeros_like(q))

    def push(x: FloatArray) -> FloatArray:
        return np.asarray(law.velocity(t, x) if first_order else law.flow(t, x, np.zeros_like(x))[0])

    magnitude = float(np.abs(q - q.mean(axis=0)).max()) or 1.0
    force = push(q)
    for _ in range(_STEPS):
        by_position: Any = law.slopes(t, q) if first_order else law.derivatives(t, q, np.zeros_like(q))[0]
        stiffness = by_position.toarray()
        if np.abs(force).max() <= _CONVERGED * float(np.abs(stiffness).max()) * magnitude:
            return q
        step = -np.linalg.lstsq(stiffness, force.ravel(), rcond=_RANK)[0].reshape(q.shape)
        share = 1.0
        while True:
            next_force = push(q + share * step)
            if np.linalg.norm(next_force) < np.linalg.norm(force) or share < 1e-3:
                break
            share *= _SHORTEN
        q, force = q + share * step, next_force
    raise SolverError(
        f"no state of rest of {law.title} found near there: the largest force left is "
        f"{float(np.linalg.norm(force, axis=1).max()):.3g}; start nearer to one, or linearise as it is"
    )
