"""Laws that are compiled together with the integrator: many steps in one call (`flockana.kernels.advance`)."""

from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.interrupts import defer_sigint
from flockana.dynamics.encounters import StepChecks, at_a_pole
from flockana.dynamics.frame import Frame, Plan
from flockana.dynamics.stepper import Stepper
from flockana.jit import thawed
from flockana.kernels.advance import advance
from flockana.kernels.march import CROWDED, NOT_FINITE, SINGULAR, TOO_SMALL, Block, Room
from flockana.kernels.runge_kutta import Method
from flockana.kernels.tableaus import tableau
from flockana.kernels.verlet import SKIN, list_pairs, no_pairs, spatial_order
from flockana.laws.law import Law
from flockana.laws.terms.term import Compiled

METHODS = ("DOP853", "RK45", "RK23", "RK4")  # that there are compiled
_STEPS, _NUMBERS = 512, 6_000_000  # in one call, at most: steps, and numbers kept of them
_LISTS = 8  # lists made after which agents are sorted by cell again
_UNLISTED = "scipy-DOP853"  # which looks at pairs in blocks
_SMALL = "Required step size is less than spacing between numbers."  # scipy's words


class Engine(Stepper):
    """Compiled integrator: a law and a method, at the current time of a run.

    Agents are sorted by cell, so that a pair's are close in memory: `order` has every agent's own number.
    """

    def __init__(self, form: Compiled, frame: Frame, plan: Plan, y: FloatArray, f: FloatArray) -> None:
        self.frame, self.plan, (n, m) = frame, plan, frame.shape
        self.failure, self.evaluations, self.redone = "", 1, 0
        self.stops, self.due = plan.stops[plan.stops > frame.t0], plan.due[plan.due > frame.t0]
        self.pairs, self._sorted, self._h = no_pairs(n, m), -_LISTS, 0.0
        rows = int(np.clip(_NUMBERS // (4 * frame.size), 1, _STEPS)) + 1
        self.block = Block(*(np.empty((rows, *shape)) for shape in ((), y.shape, y.shape, ())))
        for each, value in zip(self.block, (frame.t0, y, f, np.nan), strict=True):
            each[0] = value
        self._system = form.system(frame.view, n, m)
        self.order = self._system.order
        given: list[Any] = [thawed(each) if isinstance(each, np.ndarray) else each for each in tableau(plan.method)]
        self._room = Room(np.empty((int(max(given[4])) + 1, y.size)), np.empty(y.size))
        rtol, floor, longest = plan.control
        given += [float(rtol), tuple(map(float, floor)), float(longest)]
        self._method = Method(*given)

    def advance(self, checks: StepChecks) -> int:  # noqa: D102
        if self._system.reach[0] > 0.0 and self.pairs.made >= self._sorted + _LISTS:
            self._sort()
        judged = checks.judged(self.order)
        with defer_sigint():  # raised while numba makes the result of a kernel, it crashes the process
            made = advance(
                self._system, self._method, self.block, self._room, self._h, (self.pairs, checks.near), self.stops,
                self.due, judged,
            )  # fmt: skip
        self._h, self.pairs, checks.near, self._samples = made.h, made.pairs, made.near, (made.states, made.work)
        self.evaluations, self.redone = self.evaluations + made.evaluations, self.redone + made.redone
        t = float(self.block.t[made.steps])
        if made.status == CROWDED:
            self.failure = f"more pairs within reach at t = {t:g} than a list has room for: try method='{_UNLISTED}'"
        elif made.status == SINGULAR and not checks.switch_to_blocks():
            self.failure = at_a_pole(t)
        elif made.status in (TOO_SMALL, NOT_FINITE):
            why = _SMALL if made.status == TOO_SMALL else "the state is no longer finite"
            self.failure = self.plan.describe_failure(t + made.h, why)
        return int(made.steps)

    def _sort(self) -> None:
        """Sort the agents by cell."""
        (n, m), reach = self.frame.shape, sum(self._system.reach)
        order = spatial_order(self.block.y[0, : n * m].reshape(n, m), reach)
        for rows in (self.block.y, self.block.f):
            both = rows[0, : 2 * n * m].reshape(2, n, m)
            both[:] = both[:, order]
        self.order = self.order[order]
        self._system = self._system._replace(order=self.order)
        self.pairs = self.pairs._replace(places=np.empty((0, m)))
        self._sorted = self.pairs.made

    def between(self) -> tuple[FloatArray, FloatArray, FloatArray]:  # noqa: D102
        states, work = self._samples
        return self.due[: len(work)], states, work


def engine_of(law: Law, q0: FloatArray, p0: FloatArray, t0: float, plan: Plan) -> Engine | None:
    """Return the compiled integrator of a law and a method; None without a compiled form, or with too many pairs."""
    form = law.compiled(q0.shape[1]) if plan.method in METHODS else None
    if form is None or not np.isfinite(law.hamiltonian(t0, q0, p0)):
        return None
    few = np.empty(1, np.uint32)
    if list_pairs(q0, (1.0 + SKIN) * form.reach, few, few)[2] < 0:
        return None
    frame = Frame.of(t0, q0, p0, energetic=True)
    u, power = law.flow(t0, q0, p0)
    y0 = frame.start(q0, p0)
    return Engine(form, frame, plan, y0, np.concatenate([y0[frame.size : 2 * frame.size], u.ravel(), [power]]))
