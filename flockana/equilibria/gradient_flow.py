"""Gradient flow q' = −∇U of a law's structural potential, to its limit."""

from dataclasses import dataclass
from threading import RLock
from typing import Any

import numpy as np

from flockana.base.errors import SolverError
from flockana.base.value_checks import FloatArray, ensure_points, ensure_positive
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import polish
from flockana.laws import Algorithm1, Algorithm2, ensure_one_gain
from flockana.measures.centre_frame import moving_frame

_NEWTON_FROM = 1e-7  # relative force at which Newton's method takes over: a weak bond near r pulls no harder before
_NEWTON_AGAIN = 0.1  # of the force at which it led astray
_NOT_YET = 10.0  # times the force that is waited for: where it was asked for last, a correction beside a step's end
_TOL = 1e-11  # relative force at which it ends
_MOST_STEPS = 100_000  # 200 agents take some thousands; far from all numbers of use steps shrink without end
_ONE_AT_A_TIME = RLock()  # before scipy 1.17 two LSODAs in threads of one process may not step in turns


@dataclass(frozen=True)
class GradientLimit:
    """Limit of the gradient flow q' = −∇U of a potential: configuration, residual force and flow time."""

    q: FloatArray  # shape (n, m)
    force: float  # largest residual force over that of the law's `scales`
    time: float  # time of the flow that was integrated, in units of d over the force scale
    converged: bool  # whether `force` fell below the tolerance


def structural_force(law: Algorithm1 | Algorithm2, q: FloatArray) -> FloatArray:
    """Return −∇V(q) of Algorithm 1, −∇U_λ of Algorithm 2 in the moving frame, shape (n, m)."""
    return moving_frame(law.flow(0.0, q, np.zeros_like(q))[0])


def gradient_flow(law: Algorithm1 | Algorithm2, q0: Any, *, horizon: float = 1e4) -> GradientLimit:
    """Follow q' = −∇U from q0 until the force vanishes; the last digits by Newton's method."""
    from scipy.integrate import LSODA  # BDF with the Jacobian, in compiled code; Adams' formulas where nothing is stiff

    q = ensure_points("q0", q0)
    if law.target is not None:
        ensure_one_gain(law.gains)
    potential, shape, scale = Potential(law), q.shape, law.scales.force
    horizon = ensure_positive("horizon", horizon)
    pace = law.alpha.length / scale
    nearby = np.inf  # largest component of the force where it was asked for last, beside the end of a step

    def rate(t: float, y: FloatArray) -> FloatArray:
        nonlocal nearby
        force = structural_force(law, y.reshape(shape)).ravel()
        nearby = float(np.abs(force).max())
        if not nearby < np.inf:  # LSODA would try to step over it for ever
            far = float(np.abs(y).max())
            raise SolverError(f"the force is not finite, with coordinates up to {far:.3g}: start nearer to the origin")
        return pace * force

    def slope(t: float, y: FloatArray) -> FloatArray:
        return -pace * law.stiffness(y.reshape(shape)).toarray()

    with _ONE_AT_A_TIME, np.errstate(over="ignore", invalid="ignore"):  # what overflows raises, in words
        solver = LSODA(rate, 0.0, q.ravel(), horizon, rtol=1e-6, atol=1e-8 * law.alpha.length, jac=slope)
        level = _NEWTON_FROM
        for _ in range(_MOST_STEPS):
            if solver.status != "running":
                break
            solver.step()
            if nearby > _NOT_YET * level * scale:
                continue
            state = solver.y.reshape(shape)
            force = potential.residual(state)
            if force <= level:
                polished = polish(potential, state)
                if (residual := potential.residual(polished)) <= _TOL:
                    return GradientLimit(polished, residual, float(solver.t), True)
                level = _NEWTON_AGAIN * force  # that was another equilibrium: flow on towards this one
        state = solver.y.reshape(shape)
        return GradientLimit(state, potential.residual(state), float(solver.t), False)
