"""Solver steps between the samples of a run, the basis of bounds at all times.

Samples at times of one's own choice need not resolve the motion between them; the solver's steps do. So a run keeps
those between its samples, in bounded memory: beyond it every other one is left out, and how far the path through the
remaining ones is from the path through all, which control polygons bound, is added to the error that bounds allow for.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.dynamics.run_samples import Sample, Samples
from flockana.kernels.path_detours import detours

MOST = 2**24  # numbers that are kept of the steps between samples: 128 MiB
_TOGETHER = 256  # steps that came one at a time are put into one array, each: small arrays are mostly overhead


class Course(NamedTuple):
    """Samples and solver steps of a run in order of time, with an error bound of the path between or None."""

    t: FloatArray
    q: FloatArray
    p: FloatArray
    u: FloatArray
    slack: FloatArray | None


@dataclass(frozen=True, eq=False)
class Between:
    """The solver's own steps between the samples of a run."""

    t: FloatArray  # Their times, rising, none of which is that of a sample
    q: FloatArray  # q, p, u: Positions, velocities, accelerations
    p: FloatArray
    u: FloatArray
    # For every interval of the T samples and S steps together: how far each agent's path through all steps that were
    # made is from that through those kept. None if all were kept.
    slack: FloatArray | None = None

    def __post_init__(self) -> None:
        flock = (len(self.t), *np.shape(self.q)[1:])
        for name in ("t", "q", "p", "u", *(() if self.slack is None else ("slack",))):
            array = np.ascontiguousarray(getattr(self, name), dtype=np.float64).view()
            if name in "qpu" and array.shape != flock:
                raise ArgumentError(
                    f"between.{name} has shape {array.shape}: expected {len(self.t)} steps of one flock"
                )
            if not np.isfinite(array).all():
                raise ArgumentError(f"between.{name}: expected finite numbers")
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        if self.t.ndim != 1 or self.q.ndim != 3 or not (np.diff(self.t) > 0.0).all():
            raise ArgumentError("between: expected rising times and arrays of shape (S, n, m)")

    def check_fits(self, t: FloatArray, q: FloatArray) -> None:
        """Raise unless these steps lie between the samples of a run."""
        intervals = (len(t) + len(self.t) - 1, q.shape[1])
        if self.q.shape[1:] != q.shape[1:] or (self.slack is not None and self.slack.shape != intervals):
            raise ArgumentError(f"between.q has shape {self.q.shape}: expected steps of the flock of q {q.shape}")
        if len(self.t) and (self.t[0] <= t[0] or self.t[-1] >= t[-1] or np.isin(self.t, t).any()):
            raise ArgumentError("between.t: expected times strictly between those of the samples")

    def within(self, t: FloatArray, kept: FloatArray) -> Between | None:
        """Return the steps that lie within a window of the run; None for a window of one sample."""
        if len(kept) == 1:
            return None
        start, end = kept[0], kept[-1]
        is_inside, slack = (self.t > start) & (self.t < end), self.slack
        if slack is not None:
            times = np.sort(np.concatenate([t, self.t]))
            slack = slack[(times[:-1] >= start) & (times[1:] <= end)]
        return Between(self.t[is_inside], self.q[is_inside], self.p[is_inside], self.u[is_inside], slack)

    def in_units(self, length: float, time: float) -> Between:
        """Return the solver steps in other units of length and time (`flockana.rescale`)."""
        slack = None if self.slack is None else self.slack * length
        return Between(self.t * time, self.q * length, self.p * (length / time), self.u * (length / time**2), slack)


def merged(t: FloatArray, q: FloatArray, p: FloatArray, u: FloatArray, between: Between | None) -> Course:
    """Return samples and the steps between them, merged in order of time."""
    if between is None:
        return Course(t, q, p, u, None)
    pairs = (t, between.t), (q, between.q), (p, between.p), (u, between.u)
    order = np.argsort(np.concatenate(pairs[0]))
    t, q, p, u = (np.concatenate(pair)[order] for pair in pairs)
    return Course(t, q, p, u, between.slack)


class Recorder:
    """Recorder of samples and of the steps between them, which keeps a limited number of steps."""

    def __init__(self, most: int = MOST) -> None:
        self.most, self._held, self._thinned = most, 0, False
        self._samples: list[Samples] = []  # as they came: no memory beside the run's own
        self._steps: list[Samples] = []
        self._single: list[Samples] = []  # the last steps, as far as they came one at a time
        self._slack: dict[float, FloatArray] = {}  # by time: of the path from there to the next, where it is off

    def add(self, some: Samples) -> None:
        """Add samples or steps; samples before some steps must be added first."""
        if some.wanted:
            self._samples.append(some)
            return
        if not self._samples:  # no earlier steps are in use
            self._steps, self._single, self._held = [], [], 0
        self._limit_memory()
        self._held += 3 * some.q.size
        self._single.append(some)
        if len(some.t) > 1 or len(self._single) >= _TOGETHER:
            self._assemble()

    def _assemble(self) -> None:
        if len(self._single) > 1:
            self._single = [Samples.joined(self._single)]
        self._steps += self._single
        self._single = []

    def between(self) -> Between | None:
        """Return the steps between the samples; None without any."""
        self._assemble()
        if not (self._steps and self._samples):
            return None
        self._limit_memory()
        times = np.concatenate([sample_block.t for sample_block in self._samples])
        steps = Samples.joined(self._steps)
        is_inside = (steps.t > times[0]) & (steps.t < times[-1])
        if not is_inside.any():
            return None
        steps = steps if is_inside.all() else steps.at(is_inside)
        if not self._thinned:
            return Between(steps.t, steps.q, steps.p, steps.u)
        exact, knots = np.zeros(steps.q.shape[1]), np.sort(np.concatenate([times, steps.t]))
        slack = np.array([self._slack.get(knot, exact) for knot in knots[:-1].tolist()])
        return Between(steps.t, steps.q, steps.p, steps.u, slack)

    def _limit_memory(self) -> None:
        """Drop every other step if there are too many, and free their memory."""
        # Where a step is left out, no sample may come between its neighbours any more.
        if self._held <= self.most or not self._samples:
            return
        self._assemble()
        first_time = self._samples[0].t[0]
        knots = sorted((one for some in (*self._samples, *self._steps) for one in some.each()), key=lambda one: one.t)
        knots = [one for one in knots if one.t >= first_time]
        exact, before, retained, leave = np.zeros(len(knots[0].q)), knots[0], list[Sample](), False
        for one, after in zip(knots[1:], [*knots[2:], None], strict=True):
            if not one.wanted:
                leave = not leave
                if leave and after is not None:
                    slacks = (self._slack.get(before.t, exact), self._slack.pop(one.t, exact))
                    self._slack[before.t] = _detours(before, one, after, *slacks)
                    continue
                retained.append(one)
            before = one
        t, q, p, u = (np.array([getattr(one, name) for one in retained]) for name in ("t", "q", "p", "u"))
        self._steps, self._thinned = [Samples(t, q, p, u, {}, wanted=False)], True
        self._held = 3 * self._steps[0].q.size


def _detours(before: Sample, middle: Sample, after: Sample, slack: FloatArray, later: FloatArray) -> FloatArray:
    """Return a bound of each agent's path error if the middle one of three steps is left out."""
    knots = (before, middle, after)
    states = (tuple(np.ascontiguousarray(array) for array in (knot.q, knot.p, knot.u)) for knot in knots)
    farthest: FloatArray = detours(tuple(knot.t for knot in knots), *states, slack, later)
    return farthest
