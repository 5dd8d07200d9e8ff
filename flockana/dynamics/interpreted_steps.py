"""Steps of laws that are not compiled, one by one in Python.

Solvers with a past (BDF, LSODA) begin anew where a step is made again.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.dynamics.encounters import at_a_pole
from flockana.dynamics.moving_frame import Plan
from flockana.dynamics.run_samples import Start, finite
from flockana.dynamics.stepper import Integrator
from flockana.kernels.verlet_list import no_pairs
from flockana.laws.first_order_law import VelocityLaw
from flockana.laws.law import LawOfMotion
from flockana.solvers.solver import Limits

_ACROSS = 100.0  # times the rounding of the time: steps so short lead across a switch of laws in turn


class Interpreter(Integrator):
    """Integrator that steps a law in Python."""

    def __init__(self, law: LawOfMotion, start: Start, plan: Plan) -> None:
        super().__init__(law, start, plan)
        self.order, self.pairs = np.arange(len(start.q), dtype=np.uint64), no_pairs(0, self.frame.shape[1])
        self._rhs = self._rate()
        self.begin()

    def begin(self) -> None:
        """Start a new solver at the current state, without memory of earlier steps."""
        if self.stops.size:
            if self.plan.solver.dt:
                t, y = float(self.block.t[0]), self.block.y[0, : self._solved].copy()
                self._fill(0, t, y, self._rhs(t, y))
            self._open(self.stops[0], None)
            self._write(0)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return acceleration and energy rate of the law, as `Law.flow` does."""
        return self.law.flow(t, q, p)

    @property
    def _solved(self) -> int:
        """Number of components of the state vector that the solver integrates."""
        return int(self.block.y.shape[1])

    def _rate(self) -> Callable[[float, FloatArray], FloatArray]:
        """Return the right-hand side of the differential equation that the solver integrates."""
        return self.frame.rate(self._counted)

    def _fill(self, row: int, t: float, y: FloatArray, f: FloatArray) -> None:
        """Store time, state vector and its time derivative in one row of the block of steps."""
        self.block.t[row], self.block.y[row], self.block.f[row] = t, y, f

    def _counted(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return acceleration and energy rate of the law, and count the evaluation."""
        u, rate = self.flow(t, q, p)
        return self._count(t, u), rate

    def _count(self, t: float, u: FloatArray) -> FloatArray:
        """Count one evaluation of the law and return its value; stop LSODA if that is not finite."""
        self.evaluations += 1
        if self.plan.solver.name == "LSODA" and not finite(u):  # it would try to step over it for ever
            raise FloatingPointError(f"{self.law.title} gives no finite values at t = {t:g}")
        return u

    def _open(self, until: float, first: float | None) -> None:
        """Open a new solver from the current state to a given time, with an optional first step size."""
        t, y, f = float(self.block.t[0]), *(item[0, : self._solved].copy() for item in self.block[1:3])
        self._course: Callable[[float], FloatArray] | None = None
        part_sizes, control = (self.frame.size, self.frame.size, int(self.frame.energetic)), self.plan.control
        floors = np.repeat(control.floor, part_sizes)[: self._solved]
        limits = Limits(until, control.rtol, floors, control.longest, first)
        self._solver: Any = self.plan.solver.open(self._rhs, t, y, f, limits)

    def _write(self, row: int) -> bool:
        """Store the solver's state and rate in one row of the block; return whether they are finite."""
        t, y, f = float(self._solver.t), self._solver.y, getattr(self._solver, "f", None)
        self._fill(row, t, y, self._rhs(t, y) if f is None else f)
        return finite(self.block.y[row], self.block.f[row])

    def advance(self) -> int:
        """Make one accepted step; return 1, or 0 if the run ends, with the reason in `failure`."""
        while self.step():
            if self.checks.energetic:
                for row in (0, 1) if np.isnan(self.block.energy[0]) else (1,):
                    t = float(self.block.t[row])
                    self.block.energy[row] = self.law.hamiltonian(t, *self.frame.state(t, self.block.y[row]))
            shorter_step, is_singular = self.checks.examine(self.block, self.order, self.pairs)
            if is_singular:
                self.failure = at_a_pole(float(self.block.t[0]))
                return 0
            if not shorter_step:
                return 1
            self.notes["redone"] += 1
            self._open(self.stops[0] if self.plan.solver.dt else float(self.block.t[0]) + shorter_step, shorter_step)
        return 0

    def step(self) -> bool:
        """Try one solver step; return whether it succeeds, with the reason in `failure` if not."""
        if self._solver.status == "finished":  # a stop, or a step that was made again ended here
            h = getattr(self._solver, "h_abs", None)  # the next step, unless the last one only led across a switch
            across = h is None or h < _ACROSS * np.spacing(abs(float(self.block.t[0])))
            self._open(self.stops[0], None if across else h)
        self._course, start = None, float(self.block.t[0])
        try:
            with np.errstate(over="ignore", invalid="ignore"):  # such a state ends the run, in words
                reason_text = self._solver.step()
            if self._solver.status != "failed" and self._write(1):
                if self.block.t[1] > start:
                    return True
                self.failure = self.plan.describe_failure(start, "its step is lost in the rounding of the time")
                return False
            reason_text = reason_text or "the state is no longer finite"
        except (ValueError, FloatingPointError, np.linalg.LinAlgError) as error:  # implicit solvers raise on NaN
            if isinstance(error, ArgumentError):
                raise
            reason_text = str(error)
        self.failure = self.plan.describe_failure(float(self._solver.t), reason_text)
        return False

    def between(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return times, states and work integral of the samples within the last step."""
        due_times = self.due[self.due < self.block.t[1]]
        states, work_integral = np.empty((due_times.size, 3, *self.frame.shape)), np.full(due_times.size, np.nan)
        for k, t in enumerate(due_times.tolist()):
            y = self.course(t)
            q, p = self.frame.state(t, y)
            states[k] = q, p, self.flow(t, q, p)[0]
            work_integral[k] = y[-1] if self.frame.energetic else np.nan
        return due_times, states, work_integral

    def course(self, t: float) -> FloatArray:
        """Return the state vector at a time within the last step."""
        if self._course is None:
            self._course = self._solver.dense_output()
        values: FloatArray = self._course(t)
        return values


class VelocityInterpreter(Interpreter):
    """Integrator of a first-order law: it steps positions, and writes positions and velocities."""

    law: VelocityLaw

    @property
    def _solved(self) -> int:
        return self.frame.size

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return the accelerations along the motion, and NaN as energy rate, which the law lacks."""
        return self.law.acceleration(t, q), np.nan

    def _rate(self) -> Callable[[float, FloatArray], FloatArray]:
        def rhs(t: float, x: FloatArray) -> FloatArray:
            return self._count(t, self._relative(self.law.velocity(t, self._state(t, x, x)[0])))

        return rhs

    def _relative(self, v: FloatArray) -> FloatArray:
        return v.ravel() - self.frame.drift[: self.frame.size]

    def _state(self, t: float, x: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        return self.frame.state(t, np.concatenate([x, v]))

    def _fill(self, row: int, t: float, y: FloatArray, f: FloatArray) -> None:
        u = self.flow(t, *self._state(t, y, f))[0]
        super()._fill(row, t, np.concatenate([y, f]), np.concatenate([f, u.ravel()]))

    def course(self, t: float) -> FloatArray:  # noqa: D102
        x = super().course(t)
        return np.concatenate([x, self._relative(self.law.velocity(t, self._state(t, x, x)[0]))])
