"""Samples yielded by integrators, and counts of steps and evaluations of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray


class Sample(NamedTuple):
    """State of a run at one time: positions, velocities, accelerations and further values."""

    t: float
    q: FloatArray
    p: FloatArray
    u: FloatArray
    extra: dict[str, FloatArray]
    wanted: bool = True


class Samples(NamedTuple):
    """Instants of a run along a first axis: samples, or (if not `wanted`) integrator steps between samples."""

    t: FloatArray
    q: FloatArray
    p: FloatArray
    u: FloatArray
    extra: dict[str, FloatArray]
    wanted: bool = True

    @classmethod
    def joined(cls, blocks: Sequence[Samples]) -> Samples:
        """Return the instants of several blocks as one, flagged as the first block is."""
        t, q, p, u = (np.concatenate(series) for series in zip(*(block[:4] for block in blocks), strict=True))
        extra_series = {name: np.concatenate([block.extra[name] for block in blocks]) for name in blocks[0].extra}
        return cls(t, q, p, u, extra_series, blocks[0].wanted)

    def at(self, rows: Any) -> Samples:
        """Return the samples at selected indices, as views where `rows` is a slice."""
        extra_series = {name: values[rows] for name, values in self.extra.items()}
        return Samples(self.t[rows], self.q[rows], self.p[rows], self.u[rows], extra_series, self.wanted)

    def each(self) -> Iterator[Sample]:
        """Yield the samples one by one."""
        for k, t in enumerate(self.t.tolist()):
            extra_values = {name: values[k] for name, values in self.extra.items()}
            yield Sample(t, self.q[k], self.p[k], self.u[k], extra_values, self.wanted)


class Start(NamedTuple):
    """Initial state of a run, with the law's acceleration and energy rate."""

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
    def sample(self) -> Samples:
        """The initial state as a single sample."""
        extra_values = {**self.memory, **({"work": np.array(0.0)} if self.energetic else {})}
        extra = {name: np.asarray(values)[None] for name, values in extra_values.items()}
        return Samples(np.array([self.t]), self.q[None], self.p[None], self.u[None], extra)


@dataclass
class Tally:
    """Status, message and numbers of steps and evaluations of a run, kept even if it is interrupted."""

    evaluations: int = 0  # of the law
    steps: int = 0
    status: str = "complete"  # as in `Trajectory`
    message: str = "reached the end of the time span"
    notes: dict[str, Any] = field(default_factory=dict)  # further entries of `Trajectory.stats`

    def fail(self, message: str) -> None:
        """Record that the run ended early, and why."""
        self.status, self.message = "failed", message


def copied(memory: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Return copies of a map's memory arrays, safe from changes in place."""
    return {name: np.array(value) for name, value in memory.items()}


def finite(*values: Any) -> bool:
    """Whether all numbers in all arrays are finite."""
    return all(bool(np.isfinite(value).all()) for value in values)
