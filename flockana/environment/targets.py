"""γ-agents with given paths: the fixed or moving reference (q_r, p_r) of Algorithms 2 and 3.

A target hands over the p_r that the law is given and, apart from it, the true rate dq_r/dt; sources sometimes print
a p_r that is not that rate, which is allowed here and reported where a theorem needs it.
"""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import cos, inf, pi, sin
from typing import Any, ClassVar, Self

import numpy as np

from flockana.base import value_checks
from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, normalise
from flockana.environment.target import Harmonic, Target

_STEP = 1e-5  # of the path's own time, for dq_r/dt by central difference: error about 1e-10 relative on smooth paths
_RESOLVED = 2.0**-26  # of |t|: a shorter step would lose half its digits in the rounding of t


def _harmonic(a: Any, *, b: Any = 0.0, c: Any = 0.0, s: Any = 0.0, e: Any = 0.0, omega: float = 0.0) -> Harmonic:
    """Return the path a + bt + c cos ωt + s sin ωt with offset e of p_r; omitted terms are zero."""
    return Harmonic(np.array([np.broadcast_to(item, np.shape(a)) for item in (a, b, c, s, e)], dtype=np.float64), omega)


class _HarmonicTarget(Target):
    """Base class of γ-agents with a path given in closed form by `harmonic`."""

    motion = ("position", "rate", "state")

    @property
    @abstractmethod
    def harmonic(self) -> Harmonic: ...

    def position(self, t: float) -> FloatArray:
        return self.harmonic.position(t)

    def rate(self, t: float) -> FloatArray:
        return self.harmonic.rate(t)

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:
        return self.position(t), self.rate(t) + self.harmonic.terms[4]

    @property
    def consistent(self) -> bool | None:
        return not self.harmonic.terms[4].any()

    def acceleration_bound(self, t0: float) -> float | None:
        return self.harmonic.largest_acceleration

    @property
    def feature(self) -> float | None:
        return inf if self.harmonic.largest_acceleration == 0.0 else 1.0 / abs(self.harmonic.omega)


@dataclass(frozen=True)
class StaticTarget(_HarmonicTarget):
    """Fixed γ-agent at q; a velocity p ≠ 0 may be reported with it, as Theorem 6 does.

    Parameters
    ----------
    p : array_like, shape (m,), or 0
        Velocity p_d handed to the law; the position stays fixed.

    Examples
    --------
    >>> StaticTarget((5.0, 5.0)).state(3.0)
    (array([5., 5.]), array([0., 0.]))
    """

    q: Any
    p: Any = 0.0

    units: ClassVar[Mapping[str, Powers]] = {"q": (1, 0), "p": (1, -1)}

    def __post_init__(self) -> None:
        m = value_checks.freeze_vector(self, "q").size
        if np.isscalar(self.p) and self.p == 0:
            object.__setattr__(self, "p", np.zeros(m))
        value_checks.freeze_vector(self, "p", m)

    @cached_property
    def harmonic(self) -> Harmonic:  # noqa: D102
        return _harmonic(self.q, e=self.p)


@dataclass(frozen=True)
class LinearTarget(_HarmonicTarget):
    """γ-agent on a straight line: q_r = q + p t.

    Parameters
    ----------
    q : array_like, shape (m,)
        Position at t = 0.

    Examples
    --------
    >>> LinearTarget((200.0, 30.0), (5.0, 0.0)).position(2.0).tolist()
    [210.0, 30.0]
    """

    q: Any
    p: Any

    units: ClassVar[Mapping[str, Powers]] = {"q": (1, 0), "p": (1, -1)}

    def __post_init__(self) -> None:
        value_checks.freeze_vector(self, "p", value_checks.freeze_vector(self, "q").size)

    @cached_property
    def harmonic(self) -> Harmonic:  # noqa: D102
        return _harmonic(self.q, b=self.p)


@dataclass(frozen=True)
class SineTarget(_HarmonicTarget):
    """γ-agent on a sine about a line: q_r = start + velocity t + A sin(2πft + φ) e_axis.

    Parameters
    ----------
    start : array_like, shape (m,)
        Position about which it swings at t = 0.
    velocity : array_like, shape (m,)
        Mean velocity.
    amplitude : float
        A, in length units.
    frequency : float
        f, in cycles per time unit.
    phase : float
        φ, in radians.
    axis : int
        Coordinate that swings.

    Examples
    --------
    >>> SineTarget((0.0, 0.0), (1.0, 0.0), amplitude=2.0, frequency=0.25).position(1.0).tolist()
    [1.0, 2.0]
    """

    start: Any
    velocity: Any
    amplitude: float
    frequency: float
    phase: float = 0.0
    axis: int = 1

    units: ClassVar[Mapping[str, Powers]] = {
        "start": (1, 0),
        "velocity": (1, -1),
        "amplitude": (1, 0),
        "frequency": (0, -1),
    }

    def __post_init__(self) -> None:
        m = value_checks.freeze_vector(self, "start").size
        value_checks.freeze_vector(self, "velocity", m)
        normalise(self, value_checks.ensure_finite_scalar, "amplitude", "frequency", "phase")
        if isinstance(self.axis, bool | np.ndarray) or self.axis not in range(m):
            raise ArgumentError(f"axis = {format_value(self.axis)}: expected a coordinate of the flock, 0 to {m - 1}")
        object.__setattr__(self, "axis", int(self.axis))

    @cached_property
    def harmonic(self) -> Harmonic:  # noqa: D102
        c, s = np.zeros((2, len(self.start)))
        c[self.axis], s[self.axis] = self.amplitude * sin(self.phase), self.amplitude * cos(self.phase)
        return _harmonic(self.start, b=self.velocity, c=c, s=s, omega=2.0 * pi * self.frequency)


@dataclass(frozen=True)
class CircleTarget(_HarmonicTarget):
    """γ-agent on a circle in the first two coordinates: centre + R (cos, sin)(2πft + φ).

    Parameters
    ----------
    centre : array_like, shape (m,)
        Centre; m = 2 or 3.
    radius : float
        R > 0.
    frequency : float
        f, in cycles per time unit.
    phase : float
        φ, in radians.

    Examples
    --------
    >>> CircleTarget((50.0, 50.0), 100.0, frequency=0.5).position(0.0).tolist()
    [150.0, 50.0]
    """

    centre: Any
    radius: float
    frequency: float
    phase: float = 0.0

    units: ClassVar[Mapping[str, Powers]] = {"centre": (1, 0), "radius": (1, 0), "frequency": (0, -1)}

    def __post_init__(self) -> None:
        if value_checks.freeze_vector(self, "centre").size < 2:
            raise ArgumentError(f"centre = {self.centre}: expected 2 or 3 components; a line holds no circle")
        normalise(self, value_checks.ensure_positive, "radius")
        normalise(self, value_checks.ensure_finite_scalar, "frequency", "phase")

    @cached_property
    def harmonic(self) -> Harmonic:  # noqa: D102
        rotation_coefficients = np.zeros((2, len(self.centre)))
        rotation_coefficients[:, :2] = (cos(self.phase), sin(self.phase)), (-sin(self.phase), cos(self.phase))
        c, s = self.radius * rotation_coefficients
        return _harmonic(self.centre, c=c, s=s, omega=2.0 * pi * self.frequency)


@dataclass(frozen=True)
class RescaledVelocity(Target):
    """γ-agent that moves as `target` but reports p_r = factor · dq_r/dt (the MSN project's mistake, E12).

    Parameters
    ----------
    factor : float
        1 gives the consistent target back, 0 a γ-agent that hides its velocity.

    Examples
    --------
    >>> RescaledVelocity(LinearTarget((0.0,), (2.0,)), 0.5).state(0.0)
    (array([0.]), array([1.]))
    """

    target: Target
    factor: float

    def __post_init__(self) -> None:
        value_checks.ensure_kind("target", self.target, Target, "a Target such as CircleTarget(...)")
        normalise(self, value_checks.ensure_finite_scalar, "factor")

    def position(self, t: float) -> FloatArray:  # noqa: D102
        return self.target.position(t)

    def rate(self, t: float) -> FloatArray:  # noqa: D102
        return self.target.rate(t)

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        return self.target.position(t), self.factor * self.target.rate(t)

    @property
    def consistent(self) -> bool | None:  # noqa: D102
        if self.target.consistent is None:
            return None
        is_resting = bool(self.target.constant_velocity) and not self.target.rate(0.0).any()
        return self.factor == 1.0 or is_resting

    def acceleration_bound(self, t0: float) -> float | None:  # noqa: D102
        return self.target.acceleration_bound(t0)

    @property
    def feature(self) -> float | None:  # noqa: D102
        return self.target.feature

    @cached_property
    def harmonic(self) -> Harmonic | None:  # noqa: D102
        path = self.target.closed_path
        if path is None:
            return None
        terms = np.zeros_like(path.terms)  # p_r is a multiple of the true rate, whatever the target's own p_r
        terms[:4] = path.terms[:4]
        return Harmonic(terms, path.omega, self.factor)


@dataclass(frozen=True)
class CallableTarget(Target):
    """γ-agent given by a function; it need not be consistent, and cannot be saved to a file.

    Parameters
    ----------
    function : callable
        ``t -> (q_r, p_r)``, two vectors of m components.
    time : float
        In which the path bends, in the user's time unit: dq_r/dt is a difference over 1e-5 of it.
    span : tuple of float
        Times between which the function is defined, all unless given. It is never called beyond: the path stays where
        the span ends, and dq_r/dt is there a difference to one side.
    changes_slower_than : float, optional
        Your statement that neither q_r nor p_r has a feature narrower than this time. Without it nobody knows what the
        function does between the times at which it is seen, and hypotheses about it are assumed.

    Raises
    ------
    ArgumentError
        If the function does not return two finite vectors of equal length at t = 0, or where its span begins.

    Examples
    --------
    >>> target = CallableTarget(lambda t: ((t, 0.0), (1.0, 0.0)))
    >>> bool(target.mismatch([0.0, 1.0]) < 1e-9)
    True
    """

    function: Callable[[float], Any]
    time: float = 1.0
    span: tuple[float, float] = (-inf, inf)
    changes_slower_than: float | None = None

    def __post_init__(self) -> None:
        normalise(self, value_checks.ensure_positive, "time")
        if self.changes_slower_than is not None:
            normalise(self, value_checks.ensure_positive, "changes_slower_than")
        if not callable(self.function):
            raise ArgumentError(f"function = {self.function!r}: expected a callable t -> (q_r, p_r)")
        try:
            start, end = (float(item) for item in self.span)
        except (TypeError, ValueError):
            raise ArgumentError(f"span = {format_value(self.span)}: expected two times, (start, end)") from None
        if not end - start > 4.0 * _STEP * self.time:
            raise ArgumentError(f"span = {self.span}: expected a start and an end, more than 4e-5 time apart")
        object.__setattr__(self, "span", (start, end))
        first_time = min(max(0.0, start), end)
        q, p = self.state(first_time)
        if q.size != p.size:
            raise ArgumentError(
                f"function({first_time:g}) gave q_r of {q.size} and p_r of {p.size} components: expected equal"
            )

    def in_units(self, length: float, time: float) -> Self:
        """Return the path in other units (`flockana.rescale`)."""

        def scaled(t: float) -> tuple[FloatArray, FloatArray]:
            q, p = self.state(t / time)
            return length * q, length / time * p

        start, end = self.span
        time_constant = None if self.changes_slower_than is None else time * self.changes_slower_than
        return type(self)(scaled, time * self.time, (time * start, time * end), time_constant)

    @property
    def feature(self) -> float | None:  # noqa: D102
        return self.changes_slower_than

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        t = min(max(t, self.span[0]), self.span[1])
        try:
            q, p = self.function(t)
        except (TypeError, ValueError) as error:
            raise ArgumentError(f"function({t:g}) failed ({error}): expected it to return (q_r, p_r)") from error
        return value_checks.ensure_vector(f"q_r({t:g})", q), value_checks.ensure_vector(f"p_r({t:g})", p)

    def position(self, t: float) -> FloatArray:  # noqa: D102
        return self.state(t)[0]

    def rate(self, t: float) -> FloatArray:
        """Return the γ-agent's velocity dq_r/dt by central differences, one-sided at its span's ends."""
        step = max(_STEP * self.time, _RESOLVED * abs(t))
        if self.span[0] <= t - step and t + step <= self.span[1]:
            return (self.position(t + step) - self.position(t - step)) / (2.0 * step)
        time_step = step if t - step < self.span[0] else -step
        near_position, far_position = self.position(t + time_step), self.position(t + 2.0 * time_step)
        return (4.0 * near_position - far_position - 3.0 * self.position(t)) / (2.0 * time_step)
