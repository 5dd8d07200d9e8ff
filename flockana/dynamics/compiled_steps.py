"""Laws compiled together with the integrator: many steps in one call (`flockana.kernels.many_steps`)."""

from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.dynamics.encounters import at_a_pole
from flockana.dynamics.moving_frame import Plan
from flockana.dynamics.run_samples import Start
from flockana.dynamics.stepper import Integrator
from flockana.dynamics.steps_per_block import Pace
from flockana.jit import thawed
from flockana.kernels.adaptive_steps import FULL, NOT_FINITE, SINGULAR, TOO_SMALL, UNLISTED, Block, Room
from flockana.kernels.cell_grid import LARGE
from flockana.kernels.large_flocks import fill
from flockana.kernels.many_steps import Advanced, advance
from flockana.kernels.runge_kutta import Method
from flockana.kernels.thread_counts import several_threads
from flockana.kernels.verlet_list import COUNT, MADE, no_pairs, spatial_order, with_room
from flockana.laws.law import Law
from flockana.laws.terms.term import Compiled
from flockana.solvers.tableau import Tableau

_STEPS, _NUMBERS = 512, 6_000_000  # in one call, at most: steps, and numbers kept of them
_BEGIN = 50_000  # components times steps in the first call
_LISTS = 8  # lists made after which agents are sorted by cell again
_BLOCKS = "scipy-DOP853"  # which looks at pairs in blocks
_SMALL = "Required step size is less than spacing between numbers."  # scipy's words


class Engine(Integrator):
    """Compiled integrator: a law and a method, at the current time of a run.

    Agents are sorted by cell, so that a pair's are close in memory: `order` has every agent's own number.
    """

    in_python = False

    def __init__(self, law: Law, form: Compiled, tableau: Tableau, start: Start, plan: Plan) -> None:
        rows, (n, m) = int(np.clip(_NUMBERS // (4 * start.q.size), 1, _STEPS)), start.q.shape
        super().__init__(law, start, plan, rows)
        speeds = self.block.y[0, n * m : 2 * n * m]
        self.block.f[0], self.evaluations = np.concatenate([speeds, start.u.ravel(), [start.power]]), 1
        self.pairs, self._sorted, self._h = no_pairs(n, m), 0, 0.0
        self._pace, self._unsorted = Pace(_BEGIN // (n * m), rows), 0
        self._form, self._threads = form, plan.threads if n >= LARGE else 1
        self._system, self._sampled = form.system(self.frame.view, n, m), 0
        self._samples = self._room_for(min(self.due.size, max(1, _NUMBERS // (3 * n * m))))
        self.order, self._reach = self._system.order, sum(self._system.reach)
        constants: list[Any] = [thawed(item) if isinstance(item, np.ndarray) else item for item in tableau]
        dimension = self.block.y.shape[1]
        self._room = Room(np.empty((int(max(constants[4])) + 1, dimension)), np.empty(dimension))
        rtol, floor, longest = plan.control
        constants += [float(rtol), tuple(map(float, floor)), float(longest)]
        self._method = Method(*constants)

    def advance(self) -> int:  # noqa: D102
        checks = self.checks
        if self._unsorted <= 0:  # by a count of steps, so that no order of sums hangs on the clock
            self._unsorted = len(self.block.t) - 1
            if self._reach and self.pairs.counts[MADE] >= self._sorted + _LISTS:
                self._sort()
        with self._pace as steps, several_threads(self._threads) as several:
            judged = checks.judged(self.order, several=several)
            lists, samples = (self.pairs, checks.near), (self.due, *self._samples)
            block = Block(*(rows[: min(steps, self._unsorted) + 1] for rows in self.block))
            system = self._form.in_threads(self._system) if several else self._system  # both give the same bits
            stages = system, self._method, block, self._room, self._h
            advanced = Advanced(*advance(*stages, lists, self.stops, samples, judged))
        self._unsorted -= advanced.steps
        self._h, self._sampled = advanced.h, advanced.samples if advanced.steps else 0
        self.evaluations += advanced.evaluations
        self.notes["redone"] += advanced.redone
        t = float(self.block.t[advanced.steps])
        if advanced.status == FULL and not advanced.steps:
            self._samples = self._room_for(advanced.samples)
        elif advanced.status == UNLISTED and (pairs := with_room(self.pairs)) is not None:
            self.pairs = pairs
        elif advanced.status == UNLISTED:
            self.failure = f"more pairs within reach at t = {t:g} than a list has room for: try method='{_BLOCKS}'"
        elif advanced.status == SINGULAR and not checks.make_room():
            self.failure = at_a_pole(t)
        elif advanced.status in (TOO_SMALL, NOT_FINITE):
            reason_text = _SMALL if advanced.status == TOO_SMALL else "the state is no longer finite"
            self.failure = self.plan.describe_failure(t + advanced.h, reason_text)
        return int(advanced.steps)

    def list_pairs(self) -> bool:
        """Build the list of all pairs of agents in reach at the start; return whether it fits into memory."""
        if self._reach:
            self._sort()
            with several_threads(self._threads) as several:
                self.pairs = fill(self.pairs, self._places, self._reach, several)
        return bool(self.pairs.counts[COUNT] >= 0)

    @property
    def _places(self) -> FloatArray:
        n, m = self.frame.shape
        return self.block.y[0, : n * m].reshape(n, m)

    def _sort(self) -> None:
        """Sort the agents by spatial cell, so that neighbours are close in memory."""
        (n, m), order = self.frame.shape, spatial_order(self._places, self._reach)
        for rows in (self.block.y, self.block.f):
            state_pair = rows[0, : 2 * n * m].reshape(2, n, m)
            state_pair[:] = state_pair.take(order.view(np.int64), axis=1)
        self.order = self.order[order]
        self._system = self._system._replace(order=self.order)
        self.pairs.reach[0] = 0.0  # it lists other agents
        self._sorted = int(self.pairs.counts[MADE])

    def between(self) -> tuple[FloatArray, FloatArray, FloatArray]:  # noqa: D102
        states, work_integral = self._samples
        return self.due[: self._sampled], states[: self._sampled], work_integral[: self._sampled]

    def _room_for(self, samples: int) -> tuple[FloatArray, FloatArray]:
        """Return empty arrays for the states and the work integral at a number of samples."""
        return np.empty((samples, 3, *self.frame.shape)), np.empty(samples)


def engine_of(law: Law, start: Start, plan: Plan) -> Engine | None:
    """Return the compiled integrator of a law and a method; None without a compiled form or with too many pairs."""
    tableau = plan.solver.tableau
    form = None if tableau is None else law.compiled(start.q.shape[1])
    if tableau is None or form is None or not start.energetic:
        return None
    engine = Engine(law, form, tableau, start, plan)
    return engine if engine.list_pairs() else None
