"""Autonomous motions q' = p, p' = f(q, p), integrated ahead of the requested times.

No agent acts on a γ-agent, so its motion is found beside the flock's, to far less than a run's own error.
"""

from abc import ABC
from collections.abc import Callable
from dataclasses import is_dataclass
from functools import cached_property
from math import inf, isfinite
from threading import Lock
from typing import Any, Self

import numpy as np

from flockana.base.errors import ArgumentError, SolverError, format_value
from flockana.base.units import scaled_fields
from flockana.base.value_checks import FloatArray, ensure_positive, normalise
from flockana.environment.spring import Spring

_RTOL = 1e-12
_PIECE = 8.0  # of the system's own time, integrated at once


class Motion:
    """Solution of y' = F(y) through y(0), extended on demand."""

    def __init__(self, rate: Callable[[FloatArray], FloatArray], start: FloatArray, units: FloatArray, time: float):
        self._rate, self._start, self._units, self._piece = rate, start, units, _PIECE * time
        self._pieces: dict[bool, list[Any]] = {True: [], False: []}
        self._lock = Lock()  # a piece begins where the one before ends: two threads must not add one each

    def at(self, t: float) -> FloatArray:
        """Return y(t); raise SolverError at an invalid or unreachable time."""
        if not isfinite(t):
            raise SolverError(f"the γ-agent's own motion was asked for at t = {t}: expected a finite time")
        is_forward, k = t >= 0.0, int(abs(t) // self._piece)
        pieces = self._pieces[is_forward]
        if len(pieces) <= k:
            with self._lock:
                while len(pieces) <= k:
                    pieces.append(self._next(is_forward, pieces))
        return pieces[k](t)

    def _next(self, ahead: bool, pieces: list[Any]) -> Any:
        from scipy.integrate import solve_ivp

        segment_ends = np.array([len(pieces), len(pieces) + 1]) * (self._piece if ahead else -self._piece)
        start = pieces[-1](segment_ends[0]) if pieces else self._start
        run_options: Any = {"method": "DOP853", "dense_output": True, "rtol": _RTOL, "atol": 1e-13 * self._units}
        solution = solve_ivp(lambda _, y: self._rate(y), tuple(segment_ends.tolist()), start, **run_options)
        if not (solution.success and np.isfinite(solution.y).all()):
            raise SolverError(
                f"the γ-agent's own motion cannot be integrated beyond t = {solution.t[-1]:.6g} ({solution.message}): "
                "expected a force f_r(q_r, p_r) that keeps it finite"
            )
        return solution.sol


class Forced(ABC):
    """Motion of one agent or several under a force f_r: a frozen dataclass with q, p, `force` and `time`."""

    q: Any
    p: Any
    force: Any
    time: float

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "time")
        if not callable(self.force):
            raise ArgumentError(f"force = {self.force!r}: expected Spring(...) or a function (q_r, p_r) -> p_r'")
        _ = self._motion

    @property
    def feature(self) -> float | None:
        """Time scale of the motion if the force is a spring; None for any other function."""
        return self.force.feature if isinstance(self.force, Spring) else None

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the cached motion, which holds functions that cannot be pickled."""
        return {name: value for name, value in self.__dict__.items() if name != "_motion"}

    @cached_property
    def _motion(self) -> Motion:
        """Return the motion from q and p on; raise unless its first acceleration is finite and its time valid."""
        q, p, time = np.array(self.q), np.array(self.p), self.time
        with np.errstate(all="ignore"):
            first = self._acceleration(q, p)
        if first.shape != q.shape or not np.isfinite(first).all():
            raise ArgumentError(f"force gives {format_value(first)} at first: expected {q.shape[-1]} finite components")
        magnitudes = [float(np.abs(x).max()) for x in (q, p, first)]
        length_scale = max(magnitudes[0], magnitudes[1] * time, magnitudes[2] * (time * time)) or 1.0
        if not (isfinite(time * time * _PIECE) and 0.0 < length_scale / time < inf and isfinite(length_scale)):
            raise ArgumentError(f"time = {time:g}: expected about the time in which the motion changes, such as 1")
        units = np.repeat([length_scale, length_scale / time], q.size)

        def rate(y: FloatArray) -> FloatArray:
            x, v = y.reshape(2, *q.shape)
            return np.concatenate([v.ravel(), self._acceleration(x, v).ravel()])

        return Motion(rate, np.concatenate([q.ravel(), p.ravel()]), units, time)

    def _acceleration(self, q: FloatArray, p: FloatArray) -> FloatArray:
        """Return f_r at one or several positions, calling a user's function position by position."""
        if q.ndim == 1 or isinstance(self.force, Spring):
            return np.asarray(self.force(q, p), dtype=np.float64)
        return np.array([self.force(*item) for item in zip(q, p, strict=True)], dtype=np.float64)

    def in_units(self, length: float, time: float) -> Self:
        """Return the motion in other units (`flockana.rescale`)."""

        def scaled(q: FloatArray, p: FloatArray) -> FloatArray:
            return np.asarray(self.force(q / length, p * (time / length)), dtype=np.float64) * (length / time**2)

        changed_fields = scaled_fields(self, length, time)
        return type(self)(**(changed_fields if is_dataclass(self.force) else changed_fields | {"force": scaled}))

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Return positions and velocities at a time."""
        q, p = self._motion.at(float(t)).reshape(2, *np.shape(self.q))
        return q, p
