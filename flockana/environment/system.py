"""γ-agents with dynamics q_r' = p_r, p_r' = f_r(q_r, p_r), so that p_r is dq_r/dt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_positive, freeze_vector, normalise
from flockana.base.units import Powers
from flockana.environment.motion import Motion, accelerations, ensure_force, force_in_units, motion_from
from flockana.environment.target import Target


@dataclass(frozen=True)
class SystemTarget(Target):
    """γ-agents with dynamics q_r' = p_r, p_r' = f_r(q_r, p_r), so that p_r is dq_r/dt.

    Parameters
    ----------
    q, p : array_like, shape (m,)
        Its state at t = 0.
    force : callable
        f_r, such as `Spring`, or a function ``(q_r, p_r) -> p_r'`` (which cannot be written to a file).
    time : float
        In which its motion bends, in the user's time unit: pieces of eight of it are integrated at once.

    Raises
    ------
    ArgumentError
        If the force is no function, or does not return m finite components at the start.
    SolverError
        When its motion is asked for where it cannot be continued.

    Examples
    --------
    >>> from flockana.environment.spring import Spring
    >>> swing = SystemTarget((1.0,), (0.0,), Spring((0.0,), 1.0))
    >>> q_r, p_r = swing.state(np.pi / 2)
    >>> bool(abs(q_r[0]) < 1e-10 and abs(p_r[0] + 1.0) < 1e-10)
    True
    """

    q: Any
    p: Any
    force: Any
    time: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {"q": (1, 0), "p": (1, -1), "time": (0, 1)}

    def __post_init__(self) -> None:
        freeze_vector(self, "p", freeze_vector(self, "q").size)
        normalise(self, ensure_positive, "time")
        ensure_force(self.force)
        _ = self._motion

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the cached motion, which holds functions that cannot be pickled."""
        return {name: value for name, value in self.__dict__.items() if name != "_motion"}

    @cached_property
    def _motion(self) -> Motion:
        return motion_from(np.array(self.q), np.array(self.p), self.time, lambda q, p: accelerations(self.force, q, p))

    def in_units(self, length: float, time: float) -> SystemTarget:
        """Return the motion in other units (`flockana.rescale`)."""
        q, p = np.array(self.q) * length, np.array(self.p) * (length / time)
        return replace(self, q=q, p=p, force=force_in_units(self.force, length, time), time=self.time * time)

    def position(self, t: float) -> FloatArray:  # noqa: D102
        return self._motion.at(float(t))[: len(self.q)]

    def rate(self, t: float) -> FloatArray:  # noqa: D102
        return self._motion.at(float(t))[len(self.q) :]

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        y = self._motion.at(float(t))
        return y[: len(self.q)], y[len(self.q) :]
