"""Interface of γ-agents: position, velocity, and the velocity reported to the law."""

from abc import ABC, abstractmethod
from math import cos, sin
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray


class Harmonic(NamedTuple):
    """Path q_r = a + bt + c cos ωt + s sin ωt with p_r = factor · dq_r/dt + e, for compiled integrators."""

    terms: FloatArray  # shape (5, m): a, b, c, s, e
    omega: float = 0.0  # omega, factor: ω and what p_r is of the true rate
    factor: float = 1.0

    def position(self, t: float) -> FloatArray:
        """Return q_r(t)."""
        a, b, c, s, _ = self.terms
        return a + b * t + cos(self.omega * t) * c + sin(self.omega * t) * s

    def rate(self, t: float) -> FloatArray:
        """Return dq_r/dt."""
        _, b, c, s, _ = self.terms
        return b + self.omega * (cos(self.omega * t) * s - sin(self.omega * t) * c)

    def acceleration(self, t: float) -> FloatArray:
        """Return d²q_r/dt²."""
        c, s = self.terms[2:4]
        return 0.0 - self.omega**2 * (cos(self.omega * t) * c + sin(self.omega * t) * s)


class Target(ABC):
    """Base class of γ-agents: frozen dataclasses with `position`, `rate` and, where p_r differs, `state`."""

    @abstractmethod
    def position(self, t: float) -> FloatArray:
        """Return q_r(t), shape (m,)."""

    @abstractmethod
    def rate(self, t: float) -> FloatArray:
        """Return the true dq_r/dt, shape (m,)."""

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Return (q_r(t), p_r(t)) as handed to the law, two vectors of shape (m,)."""
        return self.position(t), self.rate(t)

    @property
    def harmonic(self) -> Harmonic | None:
        """Return the path in closed form for compiled integrators, or None."""
        return None

    def mismatch(self, times: npt.ArrayLike) -> float:
        """Return the largest ‖p_r − dq_r/dt‖ over given times: 0 for a consistent target.

        Parameters
        ----------
        times : array_like, shape (T,)
            Times to look at.
        """
        return max((float(np.linalg.norm(self.state(t)[1] - self.rate(t))) for t in np.ravel(times)), default=0.0)

    @property
    def dimension(self) -> int:
        """Dimension m of the space."""
        return int(self.position(0.0).size)
