"""State vector of integrators, relative to the mean motion of the start, and the plan of a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.dynamics.error_tolerances import Control, ErrorFloors
from flockana.solvers.solver import Solver

Flow = Callable[[float, FloatArray, FloatArray], tuple[FloatArray, float]]
_PIECES, _SPARE = 64, 16  # shorter steps for each fixed one, on average, beyond those of the first few
EXACT = Control(0.0, ErrorFloors(0.0, 0.0, 0.0))


class Plan(NamedTuple):
    """Plan of a run for an integrator: solver, times of stops and samples, tolerances."""

    solver: Solver
    stops: FloatArray  # rising times at which a step must end, the last of them the end of the run
    keep: FloatArray | None  # times of samples; None: each step is one
    control: Control = EXACT  # tolerances, and the longest step
    threads: int = 1  # at most, of a large flock

    @property
    def due(self) -> FloatArray:
        """Times of samples that are interpolated, as no step needs to end there."""
        return np.empty(0) if self.keep is None or self.solver.dt else self.keep

    def describe_failure(self, t: float, why: str) -> str:
        """Return in words why a run ended early."""
        if self.solver.dt:
            return f"{self.solver.name} left the finite numbers at t = {t:g}: reduce dt = {self.solver.dt:g}"
        return f"{self.solver.name} gave up at t = {t:g}: {why}"

    def describe_cuts(self, steps: int, passed: int) -> str:
        """Return why a run ends whose fixed steps are subdivided too often; '' if it continues."""
        if not self.solver.dt or steps <= _PIECES * (passed + _SPARE):
            return ""
        t = float(self.stops[min(passed, len(self.stops) - 1)])
        return (
            f"steps of dt = {self.solver.dt:g} are cut into more than {_PIECES} each before t = {t:g}, as agents "
            "fly too far in one, or the method is unstable: reduce dt"
        )


@dataclass(frozen=True, eq=False)
class Frame:
    """State of a run as a vector: positions and velocities relative to the mean motion of the start, and ∫ dH/dt.

    So a relative tolerance is relative to nothing that a choice of the origin, or of an inertial frame, would change.
    """

    t0: float
    origin: FloatArray  # (N,): the vector of the mean motion at t0
    drift: FloatArray  # its rate
    shape: tuple[int, int]  # (n, m)
    energetic: bool  # whether ∫ dH/dt is the vector's last component

    @classmethod
    def of(cls, t0: float, q0: FloatArray, p0: FloatArray, *, energetic: bool) -> Frame:
        """Return the moving frame of an initial state."""
        position, velocity = (np.tile(x.mean(axis=0), len(x)) for x in (q0, p0))
        rest = np.zeros(int(energetic))
        origin, drift = np.concatenate([position, velocity, rest]), np.concatenate([velocity, 0.0 * position, rest])
        return cls(t0, origin, drift, (q0.shape[0], q0.shape[1]), energetic)

    @property
    def size(self) -> int:
        """Number n·m of position coordinates of the flock."""
        return self.shape[0] * self.shape[1]

    @property
    def view(self) -> tuple[float, FloatArray, FloatArray]:
        """(t0, position at t0, velocity) of the frame, for compiled code."""
        m = self.shape[1]
        return float(self.t0), self.origin[:m].copy(), self.drift[:m].copy()

    def start(self, q0: FloatArray, p0: FloatArray) -> FloatArray:
        """State vector of the initial positions and velocities, relative to the mean motion."""
        y0: FloatArray = np.concatenate([q0.ravel(), p0.ravel(), np.zeros(int(self.energetic))]) - self.origin
        return y0

    def state(self, t: float, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the positions and velocities, in the fixed frame, of a state vector at a time."""
        full_state = y + (self.origin + self.drift * (t - self.t0))
        state_pair = full_state[: 2 * self.size].reshape(2, *self.shape)
        return state_pair[0], state_pair[1]

    def rate(self, flow: Flow) -> Callable[[float, FloatArray], FloatArray]:
        """Return the right-hand side of the equations of motion, a function of time and state vector."""
        dimension, has_energy = self.size, self.energetic

        def rhs(t: float, y: FloatArray) -> FloatArray:
            u, rate = flow(t, *self.state(t, y))
            return np.concatenate([y[dimension : 2 * dimension], u.ravel(), [rate] if has_energy else []])

        return rhs
