"""Steps of a map; encounters between the steps of a law with a past are checked."""

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import ceil

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.dynamics.encounters import Encounters, State
from flockana.dynamics.run_samples import Samples, Start, copied, finite
from flockana.dynamics.stepper import Stepper
from flockana.dynamics.steps_per_block import Pace
from flockana.laws.discrete import DiscreteLaw, IndexArray, States
from flockana.laws.first_order_law import first_order
from flockana.laws.wrapper_base import wrappers_within
from flockana.solvers.fixed_steps import FixedSteps

_NUMBERS = 6_000_000  # kept of the steps made at once, at most
_BEGIN = 16  # steps made at once at first


def count_steps(start: float, stop: float, dt: float, rounded: Callable[[float], float] = np.ceil) -> int:
    """Return the number of steps of dt between two times, whatever the rounding of the times."""
    slack = 4.0 * float(np.spacing(max(abs(start), abs(stop), stop - start)))
    return int(rounded((stop - start + (slack if rounded is np.floor else -slack)) / dt))


class MapStepper(Stepper):
    """Stepper of a map: sample k holds the state at t0 + k dt and the input of the step before.

    Samples come as many at once as steps are made at once: one by one they would cost more than a compiled step. Of
    times to keep the nearest steps are given, each once: between its steps a map has no state. A law with a past or a
    clock, and without noise, is integrated: its steps are looked at, and a step, or past, that misses an encounter
    raises.
    """

    def __init__(self, law: DiscreteLaw, start: Start, t_span: tuple[float, float], keep: FloatArray | None) -> None:
        self.law, self.t_span, self.notes, dimension = law, t_span, {}, start.q.size
        self.q, self.p, self.memory = start.q, start.p, law.start(start.q, start.p)
        self.steps, self.done = count_steps(*t_span, law.dt, np.floor), 0
        self.wanted = None if keep is None else _nearest(t_span[0], law.dt, self.steps, keep)
        self.first = start.sample if self.wanted is None or 0 in self.wanted else None
        self.pace = Pace(min(_BEGIN, 20_000 // dimension), min(law.steps_at_once, _NUMBERS // (3 * dimension)))
        self.encounters: Encounters | None = None
        if isinstance(law, FixedSteps) and wrappers_within(law.law) and not law.noisy:
            encounters = Encounters.of(law.law, len(start.q))
            self.encounters = encounters if encounters.any else None
            past_states = [State(*row[:3]) for row in self.memory.get("past", ())]
            if first_order(law) is not None:
                past_states = [State(x, v, np.zeros_like(v)) for _, x, v in past_states]
            for k, (previous_state, next_state) in enumerate(pairwise(past_states), 1 - len(past_states)):
                self._ensure_resolved(previous_state, next_state, t_span[0] + k * law.dt)

    @property
    def finished(self) -> bool:  # noqa: D102
        return self.done >= self.steps

    def advance(self) -> int:
        """Iterate the map for a block of steps; reject all from the first non-finite state on."""
        t0, dt, first, last = self.t_span[0], self.law.dt, self.done, min(self.done + self.pace.steps, self.steps)
        rows = np.arange(1, last - first + 1)
        if self.wanted is not None:
            rows = self.wanted[slice(*np.searchsorted(self.wanted, [first + 1, last + 1]))] - first
        times = t0 + np.arange(float(first), float(last)) * dt  # so a step hangs on its own time, and on no block's
        with self.pace:
            stretch, states = self._visit(times, rows)
        good, (qs, ps, us, self._series) = stretch.size, states
        if not finite(qs, ps):
            good = int(np.argmin(np.isfinite(qs).all(axis=(1, 2)) & np.isfinite(ps).all(axis=(1, 2))))
            self.failure = f"the map left the finite numbers at t = {t0 + (first + good + 1) * dt:g}"
        t = np.minimum(t0 + (stretch + first) * dt, self.t_span[1])  # which the last step may pass by its rounding
        self._made, self._kept = Samples(t, qs, ps, us, {}), np.searchsorted(stretch, rows)
        self._kept = self._kept[self._kept < good]
        if self.encounters is not None:
            q, p = self.q, self.p
            for time_point, *after in zip(t[:good].tolist(), qs, ps, us, strict=False):
                # the input of a step is its mean: that of both of its ends, to the order that paths are looked at
                self._ensure_resolved(State(q, p, after[2]), State(*after), time_point - dt)
                q, p, _ = after
        count = int(stretch[good - 1]) if good else 0
        self.evaluations += count
        return count

    def _ensure_resolved(self, before: State, after: State, t: float) -> None:
        """Raise if a step from time t skips over an encounter of agents or with an obstacle."""
        h, share = self.law.dt, self.encounters.share(self.law.dt, before, after) if self.encounters else 1.0
        if share < 1.0:
            raise ArgumentError(
                f"dt = {h:g}: agents come into range and out again, or go too far there, within the step from t = "
                f"{t:.6g}; expected dt <= {h / ceil(1.0 / share):.4g}"
            )

    def _visit(self, times: FloatArray, own: IndexArray) -> tuple[IndexArray, States]:
        """Return (step indices, states after them): the requested steps and the last, or all for checks.

        All where encounters are looked at, and where the map has left the finite numbers: which step was the first?
        """
        step_numbers = np.arange(1, len(times) + 1)
        few_numbers = step_numbers if self.encounters is not None else np.union1d(own, step_numbers[-1:])
        states = self.law.visit(times, self.q, self.p, copied(self.memory), few_numbers)
        if few_numbers.size == step_numbers.size or finite(*states[:2]):
            return few_numbers, states
        return step_numbers, self.law.visit(times, self.q, self.p, self.memory, step_numbers)

    def samples(self, count: int) -> Iterator[Samples]:
        """Yield the requested steps as samples."""
        if self._kept.size:
            # of all steps a view, of some a copy: the others are let go
            rows = slice(0, self._kept.size) if self._kept.size == len(self._made.t) else self._kept
            public = {name: values for name, values in self._series.items() if name not in self.law.private}
            yield self._made._replace(extra=public).at(rows)

    def continue_from(self, count: int) -> None:
        """Take the state at the end of a block of steps, with copied memory, as start of the next."""
        self.q, self.p, self.done = self._made.q[-1], self._made.p[-1], self.done + count
        self.memory = copied({name: values[-1] for name, values in self._series.items()})


def _nearest(t0: float, dt: float, steps: int, keep: FloatArray) -> IndexArray:
    """Return unique indices of the steps nearest to requested times; ties go to the earlier step."""
    k = np.maximum(np.ceil((keep - t0) / dt - 0.5), 0.0).astype(np.int64)

    def before(steps: IndexArray) -> npt.NDArray[np.bool_]:
        return np.asarray(t0 + steps * dt + 0.5 * dt < keep)

    while (is_late := before(k)).any():  # a quotient may round to the step beside
        k += is_late
    while (is_early := (k > 0) & ~before(k - 1)).any():
        k -= is_early
    return np.unique(k[k <= steps])
