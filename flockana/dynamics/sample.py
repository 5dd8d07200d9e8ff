"""Samples that integrators yield, and the counts that they keep of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray


class Sample(NamedTuple):
    """One instant of a run: a sample, or if it is not `wanted` a step that the integrator made between samples."""

    t: float
    q: FloatArray
    p: FloatArray
    u: FloatArray
    extra: dict[str, FloatArray]
    wanted: bool = True

    def each(self) -> Iterator[Sample]:
        """Yield the sample itself, as `Samples.each` yields each of several."""
        yield self


class Samples(NamedTuple):
    """Several instants of a run: a `Sample` with a first axis of time; either all are wanted or none."""

    t: npt.NDArray[np.floating]
    q: FloatArray
    p: FloatArray
    u: FloatArray
    extra: dict[str, FloatArray]
    wanted: bool = True

    @classmethod
    def of(cls, steps: Sequence[Sample]) -> Samples:
        """Return steps between samples, stacked into one array for each quantity."""
        t, q, p, u = (np.array([getattr(step, name) for step in steps]) for name in ("t", "q", "p", "u"))
        return cls(t, q, p, u, {}, wanted=False)

    def each(self) -> Iterator[Sample]:
        """Yield the samples one by one."""
        for k, t in enumerate(self.t.tolist()):
            extra = {name: values[k] for name, values in self.extra.items()}
            yield Sample(t, self.q[k], self.p[k], self.u[k], extra, self.wanted)


class Start(NamedTuple):
    """Initial state of a run, and what its law gives there."""

    t: float
    q: FloatArray
    p: FloatArray
    u: FloatArray
    power: float = np.nan  # dH/dt
    energy: float = np.nan  # NaN of a law without energy
    memory: Mapping[str, FloatArray] = {}  # of a map

    @property
    def energetic(self) -> bool:
        """Whether the law has an energy, so that its work can be integrated."""
        return bool(np.isfinite(self.energy))

    @property
    def sample(self) -> Sample:
        """The initial state as a sample."""
        work = {"work": np.array(0.0)} if self.energetic else {}
        return Sample(self.t, self.q, self.p, self.u, {**self.memory, **work})


@dataclass
class Tally:
    """Status and counts of a run, updated as it goes so that they survive an interruption."""

    evaluations: int = 0  # of the law
    steps: int = 0
    status: str = "complete"  # as in `Trajectory`
    message: str = "reached the end of the time span"
    notes: dict[str, Any] = field(default_factory=dict)  # further entries of `Trajectory.stats`

    def fail(self, message: str) -> None:
        """Note that the run ended early, and why."""
        self.status, self.message = "failed", message


def copied(memory: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Return copies of a map's memory, which the map may overwrite."""
    return {name: np.array(value) for name, value in memory.items()}


def finite(*values: Any) -> bool:
    """Whether all numbers in all arrays are finite."""
    return all(bool(np.isfinite(value).all()) for value in values)
