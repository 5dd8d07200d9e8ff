"""The solver's own steps between the samples of a run: what bounds at all times are made from.

Samples at times of one's own choice need not resolve the motion between them; the solver's steps do. So a run keeps
those between its samples, in bounded memory: beyond it every other one is left out, and how far the path through the
remaining ones is from the path through all, which control polygons bound, is added to the error that bounds allow for.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.kernels.detours import detours

MOST = 2**24  # numbers that are kept of the steps between samples: 128 MiB


class Course(NamedTuple):
    """Samples and the steps between them, in order of time; `slack` is what the path between may be off by, or None."""

    t: FloatArray
    q: FloatArray
    p: FloatArray
    u: FloatArray
    slack: FloatArray | None


@dataclass(frozen=True, eq=False)
class Between:
    """The solver's own steps between the samples of a run.

    Parameters
    ----------
    t : ndarray, shape (S,)
        Their times, rising, none of which is that of a sample.
    q, p, u : ndarray, shape (S, n, m)
        Positions, velocities, accelerations.
    slack : ndarray, shape (T + S - 1, n), optional
        For every interval of the T samples and S steps together: how far each agent's path through all steps that were
        made is from that through those kept. None if all were kept.

    Raises
    ------
    ArgumentError
        On shapes that do not fit each other, numbers that are not finite, or times that do not rise.
    """

    t: FloatArray
    q: FloatArray
    p: FloatArray
    u: FloatArray
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
        """Raise unless these are steps between the samples of a run."""
        intervals = (len(t) + len(self.t) - 1, q.shape[1])
        if self.q.shape[1:] != q.shape[1:] or (self.slack is not None and self.slack.shape != intervals):
            raise ArgumentError(f"between.q has shape {self.q.shape}: expected steps of the flock of q {q.shape}")
        if len(self.t) and (self.t[0] <= t[0] or self.t[-1] >= t[-1] or np.isin(self.t, t).any()):
            raise ArgumentError("between.t: expected times between those of the samples, none of them a sample's")

    def within(self, t: FloatArray, kept: FloatArray) -> Between | None:
        """The steps of a window; None if it is one sample."""
        if len(kept) == 1:
            return None
        start, end = kept[0], kept[-1]
        inside, slack = (self.t > start) & (self.t < end), self.slack
        if slack is not None:
            times = np.sort(np.concatenate([t, self.t]))
            slack = slack[(times[:-1] >= start) & (times[1:] <= end)]
        return Between(self.t[inside], self.q[inside], self.p[inside], self.u[inside], slack)

    def in_units(self, length: float, time: float) -> Between:
        """The same in other units (`flockana.rescale`)."""
        slack = None if self.slack is None else self.slack * length
        return Between(self.t * time, self.q * length, self.p * (length / time), self.u * (length / time**2), slack)


def merged(t: FloatArray, q: FloatArray, p: FloatArray, u: FloatArray, between: Between | None) -> Course:
    """Samples and the steps between them in order of time."""
    if between is None:
        return Course(t, q, p, u, None)
    order = np.argsort(np.concatenate([t, between.t]))

    def both(samples: FloatArray, steps: FloatArray) -> FloatArray:
        return np.concatenate([samples, steps])[order]

    return Course(both(t, between.t), both(q, between.q), both(p, between.p), both(u, between.u), between.slack)


class Recorder:
    """Takes in samples and the steps between them, in order of time, and keeps the steps in bounded memory.

    Parameters
    ----------
    most : int
        Numbers to keep of steps.
    """

    def __init__(self, most: int = MOST) -> None:
        self.most, self._held, self._thinned = most, 0, False
        self._knots: list[_Knot] = []
        self._exact = np.empty(0)  # slack of a path through all steps, the same for every knot

    def add(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray, *, sample: bool) -> None:
        """The next sample or step; steps before the first sample are nobody's."""
        if not (sample or self._knots):
            return
        if not self._knots:
            self._exact = np.zeros(len(q))
        self._knots.append(_Knot(t, q, p, u, sample, self._exact))
        self._held += 0 if sample else 3 * q.size
        if self._held > self.most:
            self._thin()

    def between(self) -> Between | None:
        """What is between the samples; None if nothing is."""
        last = max((k for k, knot in enumerate(self._knots) if knot.sample), default=0)
        knots = self._knots[: last + 1]
        own = [knot for knot in knots if not knot.sample]
        if not own:
            return None
        slack = np.array([knot.slack for knot in knots[:-1]]) if self._thinned else None
        t, q, p, u = (np.array([getattr(knot, name) for knot in own]) for name in ("t", "q", "p", "u"))
        return Between(t, q, p, u, slack)

    def _thin(self) -> None:
        """Leave out every other step."""
        kept, leave, self._held, self._thinned = self._knots[:1], False, 0, True
        for k in range(1, len(self._knots)):
            knot = self._knots[k]
            if not knot.sample:
                leave = not leave
                if leave and k + 1 < len(self._knots):
                    kept[-1] = _by_way_of(knot, kept[-1], self._knots[k + 1])
                    continue
                self._held += 3 * knot.q.size
            kept.append(knot)
        self._knots = kept


class _Knot(NamedTuple):
    """A sample or a step, and what the path from there to the next may be off by."""

    t: float
    q: FloatArray
    p: FloatArray
    u: FloatArray
    sample: bool
    slack: FloatArray


def _by_way_of(middle: _Knot, before: _Knot, after: _Knot) -> _Knot:
    """The one before, whose path from there to the one after leaves out a step."""
    knots = (before, middle, after)
    states = (np.ascontiguousarray(array) for knot in knots for array in (knot.q, knot.p, knot.u))
    return before._replace(slack=detours(*(knot.t for knot in knots), *states, before.slack, middle.slack))
