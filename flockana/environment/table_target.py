"""γ-agent from a table of times and positions, such as a recorded leader."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_points, ensure_series
from flockana.environment.target import Target


@dataclass(frozen=True)
class TableTarget(Target):
    """γ-agent on a smooth path through samples, saved with runs.

    Given velocities, the path is cubic between samples and has them there; without, it is the cubic spline, whose
    velocities are continuous. Before the first sample and after the last it rests where the table ends, so that runs
    should lie within.

    Parameters
    ----------
    t : array_like, shape (T,)
        Times, rising, two or more.

    Examples
    --------
    >>> path = TableTarget([0.0, 1.0, 2.0], [[0.0, 0.0], [1.0, 0.5], [2.0, 2.0]])
    >>> path.position(1.0).tolist(), path.rate(1.0).tolist(), path.position(9.0).tolist()
    ([1.0, 0.5], [1.0, 1.0], [2.0, 2.0])
    """

    t: Any
    q: Any
    p: Any = None

    units: ClassVar[Mapping[str, Powers]] = {"t": (0, 1), "q": (1, 0), "p": (1, -1)}

    def __post_init__(self) -> None:
        t, q = ensure_series("t", self.t), ensure_points("q", self.q)
        if len(t) < 2 or len(q) != len(t):
            raise ArgumentError(f"t has {len(t)} times and q {len(q)} positions: expected equal numbers, two or more")
        if not (np.diff(t) > 0.0).all():
            k = int(np.argmax(~(np.diff(t) > 0.0)))
            raise ArgumentError(f"t[{k}] = {t[k]:g} and t[{k + 1}] = {t[k + 1]:g}: expected rising times")
        object.__setattr__(self, "t", tuple(t.tolist()))
        object.__setattr__(self, "q", tuple(map(tuple, q.tolist())))
        if self.p is not None:
            p = ensure_points("p", self.p)
            if p.shape != q.shape:
                raise ArgumentError(f"p has shape {p.shape}: expected {q.shape}, as q has")
            object.__setattr__(self, "p", tuple(map(tuple, p.tolist())))

    @cached_property
    def _path(self) -> Any:
        """Cubic spline of the γ-agent's position between the first and the last sample."""
        from scipy.interpolate import CubicHermiteSpline, CubicSpline

        if self.p is not None:
            return CubicHermiteSpline(self.t, np.array(self.q), np.array(self.p))
        spline_ends: Any = "natural" if len(self.t) == 3 else "not-a-knot"
        return CubicSpline(self.t, np.array(self.q), bc_type=spline_ends)

    def position(self, t: float) -> FloatArray:  # noqa: D102
        return self._path(min(max(t, self.t[0]), self.t[-1]))

    def rate(self, t: float) -> FloatArray:
        """Return the γ-agent's velocity dq_r/dt, 0 outside the times of the table."""
        return self._path(t, 1) if self.t[0] <= t <= self.t[-1] else np.zeros(len(self.q[0]))

    consistent = True

    def acceleration_bound(self, t0: float) -> float | None:
        """Return the largest ‖d²q_r/dt²‖ from time t0 on; infinite at a jump of the velocity.

        Parameters
        ----------
        t0 : float
            Time from which on the bound holds.
        """
        end_times = [t for t in (self.t[0], self.t[-1]) if t >= t0]
        if any(self._path(t, 1).any() for t in end_times):
            return inf
        bends = self._path.derivative(2)  # linear on each piece
        start, slope = bends.c[1], bends.c[0]
        last_acceleration = start + slope * np.diff(self.t)[:, None]
        magnitudes = np.maximum(*(np.linalg.norm(x, axis=1) for x in (start, last_acceleration)))
        return float(magnitudes[np.array(self.t[1:]) > t0].max(initial=0.0))

    @property
    def feature(self) -> float | None:
        """Shortest time between two samples of the γ-agent's path."""
        return float(np.diff(self.t).min())
