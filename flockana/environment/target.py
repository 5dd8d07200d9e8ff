"""Interface of γ-agents: position, velocity, velocity reported to the law, and known properties of the path."""

from abc import ABC, abstractmethod
from math import cos, inf, sin
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.override_checks import overrides_consistently
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray


class Harmonic(NamedTuple):
    """Path q_r = a + bt + c cos ωt + s sin ωt with p_r = factor · dq_r/dt + e, for compiled integrators."""

    terms: FloatArray  # shape (5, m): a, b, c, s, e
    omega: float = 0.0  # omega, factor: ω and what p_r is of the true rate
    factor: float = 1.0

    def position(self, t: float) -> FloatArray:
        """Return the position q_r(t) of the γ-agent."""
        a, b, c, s, _ = self.terms
        return a + b * t + cos(self.omega * t) * c + sin(self.omega * t) * s

    def rate(self, t: float) -> FloatArray:
        """Return the velocity dq_r/dt of the γ-agent."""
        _, b, c, s, _ = self.terms
        return b + self.omega * (cos(self.omega * t) * s - sin(self.omega * t) * c)

    def acceleration(self, t: float) -> FloatArray:
        """Return the acceleration d²q_r/dt² of the γ-agent."""
        c, s = self.terms[2:4]
        return 0.0 - self.omega**2 * (cos(self.omega * t) * c + sin(self.omega * t) * s)

    @property
    def largest_acceleration(self) -> float:
        """Largest ‖d²q_r/dt²‖ over all times: ω² times the longer half-axis of the ellipse."""
        return float(self.omega**2 * np.linalg.norm(self.terms[2:4], 2))


_ANSWERS = ("consistent", "acceleration_bound", "feature")


class Target(ShortRepr, ABC):
    """Base class of γ-agents: frozen dataclasses with `position`, `rate` and, where p_r differs, `state`.

    A class may also say by closed form what it is: `consistent`, `acceleration_bound` and `feature`, None where that is
    unknown. A subclass that defines its motion anew loses the answers that it inherits.
    """

    motion: ClassVar[tuple[str, ...]] = ("position", "rate", "state", "harmonic")  # what the answers follow from

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if any(name in vars(cls) for name in cls.motion):
            for name in _ANSWERS:
                if name not in vars(cls):
                    setattr(cls, name, vars(Target)[name])

    @abstractmethod
    def position(self, t: float) -> FloatArray:
        """Return the position q_r(t) of the γ-agent, shape (m,)."""

    @abstractmethod
    def rate(self, t: float) -> FloatArray:
        """Return the true velocity dq_r/dt of the γ-agent, shape (m,)."""

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Return (q_r(t), p_r(t)) as handed to the law, two vectors of shape (m,)."""
        return self.position(t), self.rate(t)

    @property
    def harmonic(self) -> Harmonic | None:
        """Return the path in closed form for compiled integrators, or None."""
        return None

    @property
    def closed_path(self) -> Harmonic | None:
        """The γ-agent's path in closed form; None if unknown or overridden by a subclass."""
        is_own = overrides_consistently(type(self), "harmonic", ("position", "rate", "state"))
        return self.harmonic if is_own else None

    @property
    def consistent(self) -> bool | None:
        """Whether p_r = dq_r/dt at all times, by closed form; None if unknown."""
        return None

    def acceleration_bound(self, t0: float) -> float | None:
        """Return a bound of ‖d²q_r/dt²‖ for all t >= t0; infinite at a jump, None if unknown.

        Parameters
        ----------
        t0 : float
            Time from which on the bound holds.
        """
        return None

    @property
    def feature(self) -> float | None:
        """Time scale in which the γ-agent's path bends; infinite for a straight path, None if unknown."""
        return None

    @property
    def constant_velocity(self) -> bool | None:
        """Whether dq_r/dt is the same at all times, by closed form; None if unknown."""
        bound = self.acceleration_bound(-inf)
        return None if bound is None else bound == 0.0

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
