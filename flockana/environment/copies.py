"""Copies of a γ-agent with dynamics, one for each agent, coupled to each other or not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_nonnegative, ensure_points, ensure_positive, normalise
from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.environment.motion import Motion, accelerations, ensure_force, force_in_units, motion_from


@dataclass(frozen=True)
class Copies:
    """Copies of the γ-agent, one for each agent, each obeying f_r, coupled or not.

    q_i' = p_i, p_i' = f_r(q_i, p_i) + k₁ (q̄ − q_i) + k₂ (p̄ − p_i), with the mean q̄, p̄ of all copies. Without coupling
    (k₁ = k₂ = 0) copies that start alike stay alike, and any difference goes its own way: under f_r = 0 it grows with
    time, under a spring it swings for ever, under a repelling one it grows exponentially.

    Parameters
    ----------
    q, p : array_like, shape (n, m)
        The estimates at t = 0.
    force : callable
        f_r, as in `SystemTarget`.
    position_coupling, velocity_coupling : float
        k₁ and k₂, >= 0.
    time : float
        In which the motion bends.

    Raises
    ------
    ArgumentError
        If shapes differ, or the force is no function of the right shape.

    Examples
    --------
    Two estimates that agree on the place and not on the velocity part without coupling:

    >>> from flockana.environment.spring import Spring
    >>> free = Copies([[0.0], [0.0]], [[1.0], [1.2]], Spring((0.0,), 0.0))
    >>> q, p = free.state(10.0)
    >>> round(float(q[1, 0] - q[0, 0]), 9)
    2.0
    """

    q: Any
    p: Any
    force: Any
    position_coupling: float = 0.0
    velocity_coupling: float = 0.0
    time: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {
        "q": (1, 0),
        "p": (1, -1),
        "position_coupling": (0, -2),
        "velocity_coupling": (0, -1),
        "time": (0, 1),
    }

    def __post_init__(self) -> None:
        q, p = ensure_points("q", self.q), ensure_points("p", self.p)
        if q.shape != p.shape:
            raise ArgumentError(f"q has shape {q.shape}, p has shape {p.shape}: expected equal shapes")
        for name, value in (("q", q), ("p", p)):
            object.__setattr__(self, name, tuple(map(tuple, value.tolist())))
        normalise(self, ensure_nonnegative, "position_coupling", "velocity_coupling")
        normalise(self, ensure_positive, "time")
        ensure_force(self.force)
        _ = self._motion

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (n, m) of the estimates."""
        return len(self.q), len(self.q[0])

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the cached motion, which holds functions that cannot be pickled."""
        return {name: value for name, value in self.__dict__.items() if name != "_motion"}

    @cached_property
    def _motion(self) -> Motion:
        k1, k2 = self.position_coupling, self.velocity_coupling

        def acceleration(q: FloatArray, p: FloatArray) -> FloatArray:
            coupled = k1 * (q.mean(axis=0) - q) + k2 * (p.mean(axis=0) - p)
            return accelerations(self.force, q, p) + coupled

        return motion_from(np.array(self.q), np.array(self.p), self.time, acceleration)

    def in_units(self, length: float, time: float) -> Copies:
        """Return the motion in other units (`flockana.rescale`)."""
        return replace(
            self,
            q=np.array(self.q) * length,
            p=np.array(self.p) * (length / time),
            force=force_in_units(self.force, length, time),
            position_coupling=self.position_coupling / time**2,
            velocity_coupling=self.velocity_coupling / time,
            time=self.time * time,
        )

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Return positions and velocities of all copies, two arrays (n, m)."""
        both: FloatArray = self._motion.at(float(t)).reshape(2, *self.shape)
        return both[0], both[1]
