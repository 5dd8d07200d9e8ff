"""Interfaces for making steps: steppers driven by the loop, and integrators that fill a block."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray
from flockana.dynamics.encounters import StepChecks
from flockana.dynamics.moving_frame import Frame, Plan
from flockana.dynamics.run_samples import Samples, Start
from flockana.kernels.adaptive_steps import Block
from flockana.kernels.cell_grid import LARGE
from flockana.kernels.many_steps import parallel_record, record
from flockana.kernels.thread_counts import several_threads
from flockana.laws.law import LawOfMotion

_MANY, _SHORT = 10_000, 1e-5  # so many steps that are on average shorter than this share of the law's time end a run
_ENDLESS = 1e9  # and so do steps of which so many more would be needed: hours of the fastest flocks
_SLUGGISH, _LONG = 1e-3, 5e4  # of steps made in Python this share of the law's time, and as many more: a minute


class Stepper(ABC):
    """Base class of steppers, which advance a run from its current time."""

    first: Samples | None  # the start, if it is kept
    failure: str = ""  # why the run ends early, if it does
    evaluations: int = 0  # of the law
    notes: dict[str, Any]  # further entries of `Trajectory.stats`

    @property
    @abstractmethod
    def finished(self) -> bool:
        """Whether the end of the time span is reached."""

    @abstractmethod
    def advance(self) -> int:
        """Make steps and return how many are accepted; `failure` says why the run ends, if it does."""

    @abstractmethod
    def samples(self, count: int) -> Iterator[Samples]:
        """Yield the samples and steps to be kept from the steps just made."""

    def describe_failure(self, steps: int, count: int) -> str:
        """Return why a run ends after a given number of steps, in words; '' if it continues."""
        return self.failure

    @abstractmethod
    def continue_from(self, count: int) -> None:
        """Continue from the end of the steps just made."""


class Integrator(Stepper):
    """Base class of integrators of a continuous law, which write their steps into a block of arrays."""

    order: npt.NDArray[np.uint64]  # every agent's own number, in the order of the vectors

    law: Any
    in_python: bool = True  # whether its steps are made one by one in Python

    def __init__(self, law: LawOfMotion, start: Start, plan: Plan, rows: int = 1) -> None:
        self.law, self.plan, self.notes = law, plan, {"redone": 0}
        self.frame = Frame.of(start.t, start.q, start.p, energetic=start.energetic)
        self.checks, y = StepChecks(law, self.frame, plan), self.frame.start(start.q, start.p)
        self.stops, self.due = plan.stops[plan.stops > start.t], plan.due[plan.due > start.t]  # still to come
        self.block = Block(*(np.empty((rows + 1, *shape)) for shape in ((), y.shape, y.shape, ())))
        self.block.t[0], self.block.y[0], self.block.energy[0] = start.t, y, np.nan
        self.first = start.sample if plan.keep is None or start.t in plan.keep[:1] else None  # exact, unlike the frame
        self._counted_from = start.t, 0.0

    @property
    def finished(self) -> bool:  # noqa: D102
        return not self.stops.size

    @abstractmethod
    def between(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return times, states and work integral of the samples within the steps just made."""

    def states(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Return states, shape (count, 3, n, m), and work integral at the ends of the steps just made."""
        states, work_integral = np.empty((count, 3, *self.frame.shape)), np.empty(count)
        with several_threads(self.plan.threads if self.frame.shape[0] >= LARGE else 1) as several:
            write = parallel_record if several else record
            write(self.block, self.order, self.frame.view, states, work_integral)
        return states, work_integral

    def _samples_of(self, t: FloatArray, states: FloatArray, work: FloatArray) -> Samples:
        extra_series = {"work": work} if self.frame.energetic else {}
        return Samples(t, states[:, 0], states[:, 1], states[:, 2], extra_series)

    def samples(self, count: int) -> Iterator[Samples]:
        """Yield the steps between samples, then the samples, in blocks."""
        # Steps come first: a run that is interrupted after them has no samples whose steps are not known.
        steps = self._samples_of(self.block.t[1 : count + 1].copy(), *self.states(count))
        if self.plan.keep is None:
            yield steps
            return
        due = self._samples_of(*self.between())
        picks, apart = _among(steps.t, self.plan.keep), ~_among(due.t, steps.t)  # where a step ended it is the sample
        if not picks.all():
            rows = np.flatnonzero(~picks)
            is_contiguous = rows[-1] - rows[0] < rows.size  # then a view
            yield steps.at(slice(rows[0], rows[-1] + 1) if is_contiguous else rows)._replace(extra={}, wanted=False)
        if picks.any() or apart.any():
            both = Samples.joined([steps.at(picks), due.at(apart)])
            yield both.at(np.argsort(both.t))

    def describe_failure(self, steps: int, count: int) -> str:
        """Return why the run ends, with the nearest pair if the law has a pole at coincidence."""
        text = self.failure or self._describe_stall(steps, count)
        return text.rstrip(".") + self._name_nearest(count) if text and 0.0 in self.law.poles else text

    def _describe_stall(self, steps: int, count: int) -> str:
        """Return in words that recent steps are far too short for the law or the time span; or ''."""
        at, (start_time, previous_count) = float(self.block.t[count]), self._counted_from
        ahead = self.stops[self.stops > at]
        if self.plan.solver.dt:
            return self.plan.describe_cuts(steps, len(self.plan.stops) - ahead.size)
        if steps < previous_count + _MANY:
            return ""
        mean, self._counted_from = (at - start_time) / (steps - previous_count), (at, steps)
        law_time = np.inf if self.law.scales is None else self.law.scales.time
        step_limit = _LONG if self.in_python and mean < _SLUGGISH * law_time else _ENDLESS
        if ahead.size and ahead[-1] - at > step_limit * mean:
            return (
                f"it would take {(ahead[-1] - at) / mean:.1e} more steps to t = {ahead[-1]:g}: the last {_MANY} are "
                f"{mean:.2g} long on average; expected a shorter span or slower gains"
            )
        if np.isinf(law_time) or mean >= _SHORT * law_time:
            return ""
        text = f"steps collapse at t = {at:g}: the last {_MANY} are {mean:.2g} long on average"
        return text if 0.0 in self.law.poles else text + self._name_nearest(count)

    def _name_nearest(self, row: int) -> str:
        """Return in words which two agents are nearest to each other at a step; '' for one agent."""
        from scipy.spatial import cKDTree

        n, m = self.frame.shape
        if n == 1:
            return ""
        q = self.block.y[row, : n * m].reshape(n, m)  # as the frame sees it: finer than the positions
        neighbour_distances, neighbours = map(np.asarray, cKDTree(q).query(q, k=2))
        k = int(neighbour_distances[:, 1].argmin())
        i, j = sorted((int(self.order[k]), int(self.order[neighbours[k, 1]])))
        return f"; the nearest agents, {i} and {j}, are {neighbour_distances[k, 1]:.3g} apart"

    def continue_from(self, count: int) -> None:  # noqa: D102
        for rows in self.block:
            rows[0] = rows[count]
        t = float(self.block.t[0])
        self.stops, self.due = self.stops[self.stops > t], self.due[self.due > t]


def _among(times: FloatArray, some: FloatArray) -> npt.NDArray[np.bool_]:
    """Return a mask of the times that occur in a rising list of times, faster than `np.isin`."""
    nearest = np.append(some, np.nan)[np.searchsorted(some, times)]
    return np.asarray(nearest == times)
