"""γ-agents with dynamics q_r' = p_r, p_r' = f_r(q_r, p_r), so that p_r is dq_r/dt."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, sqrt
from typing import Any, ClassVar

from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, freeze_vector
from flockana.environment.autonomous_motion import Forced
from flockana.environment.spring import Spring
from flockana.environment.target import Target


@dataclass(frozen=True)
class SystemTarget(Forced, Target):
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
    >>> from math import pi
    >>> from flockana.environment.spring import Spring
    >>> swing = SystemTarget((1.0,), (0.0,), Spring((0.0,), 1.0))
    >>> q_r, p_r = swing.state(pi / 2)
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
        super().__post_init__()

    def position(self, t: float) -> FloatArray:  # noqa: D102
        return self.state(t)[0]

    def rate(self, t: float) -> FloatArray:  # noqa: D102
        return self.state(t)[1]

    consistent = True

    @property
    def feature(self) -> float | None:
        """Time scale of the γ-agent's motion under a spring; infinite if free, None for other forces."""
        if not isinstance(self.force, Spring):
            return None
        fastest = max(sqrt(abs(self.force.stiffness)), self.force.damping)
        return 1.0 / fastest if fastest > 0.0 else inf
