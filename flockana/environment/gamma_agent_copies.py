"""Copies of a γ-agent with dynamics, one for each agent, coupled to each other or not."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from flockana.base.short_repr import ShortRepr
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_nonnegative, ensure_state, normalise
from flockana.environment.autonomous_motion import Forced
from flockana.environment.spring import Spring


@dataclass(frozen=True)
class Copies(ShortRepr, Forced):
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
        for name, value in zip("qp", ensure_state(self.q, self.p), strict=True):
            object.__setattr__(self, name, tuple(map(tuple, value.tolist())))
        normalise(self, ensure_nonnegative, "position_coupling", "velocity_coupling")
        super().__post_init__()

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (n, m) of the array of all agents' copies of the γ-agent."""
        return len(self.q), len(self.q[0])

    @property
    def feature(self) -> float | None:
        """Time scale of the copies' motion under a spring and their coupling; None for other forces."""
        inner_feature = super().feature
        return (
            None
            if inner_feature is None
            else min(inner_feature, Spring((0.0,), self.position_coupling, self.velocity_coupling).feature)
        )

    def _acceleration(self, q: FloatArray, p: FloatArray) -> FloatArray:
        k1, k2 = self.position_coupling, self.velocity_coupling
        coupling_term = k1 * (q.mean(axis=0) - q) + k2 * (p.mean(axis=0) - p)
        return super()._acceleration(q, p) + coupling_term
