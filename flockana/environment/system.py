"""γ-agents that are systems, q_r' = p_r and p_r' = f_r(q_r, p_r): one leader for all, or a copy of it for each agent.

No agent acts on a γ-agent, so its motion is integrated beside the flock's, ahead of the times that are asked for, to
far less than a run's own error. What it tells the flock is then true: p_r is dq_r/dt.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, is_dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_nonnegative, ensure_points, ensure_positive, ensure_vector
from flockana.base.errors import ArgumentError, SolverError
from flockana.base.units import Powers, rescale
from flockana.environment.target import Target

Force = Callable[[FloatArray, FloatArray], Any]
_RTOL = 1e-12
_PIECE = 8.0  # of the system's own time, integrated at once


@dataclass(frozen=True)
class Spring:
    """f_r(q, p) = push − k x/√(1 + ‖x‖²/ℓ²) − b p, x = q − centre: a spring whose pull is bounded by kℓ, with drag.

    Parameters
    ----------
    centre : array_like, shape (m,)
        Where it pulls to.
    stiffness : float
        k; negative pushes away.
    damping : float
        b ≥ 0.
    push : array_like, shape (m,), or 0
        A constant acceleration.
    reach : float, optional
        ℓ > 0; without one the spring is linear.

    Examples
    --------
    >>> Spring((0.0, 0.0), 2.0)(np.array([3.0, 0.0]), np.array([0.0, 1.0])).tolist()
    [-6.0, 0.0]
    """

    centre: Any
    stiffness: float
    damping: float = 0.0
    push: Any = 0.0
    reach: float | None = None

    units: ClassVar[Mapping[str, Powers]] = {
        "centre": (1, 0),
        "stiffness": (0, -2),
        "damping": (0, -1),
        "push": (1, -2),
        "reach": (1, 0),
    }

    def __post_init__(self) -> None:
        centre = ensure_vector("centre", self.centre)
        push = np.zeros(centre.size) if np.isscalar(self.push) and self.push == 0 else self.push
        object.__setattr__(self, "centre", tuple(centre.tolist()))
        object.__setattr__(self, "push", tuple(ensure_vector("push", push, centre.size).tolist()))
        object.__setattr__(self, "damping", ensure_nonnegative("damping", self.damping))
        if self.reach is not None:
            object.__setattr__(self, "reach", ensure_positive("reach", self.reach))

    def __call__(self, q: FloatArray, p: FloatArray) -> FloatArray:
        """The acceleration, of one place or of several (…, m)."""
        x = q - np.array(self.centre)
        if self.reach is not None:
            x = x / np.sqrt(1.0 + np.sum(x * x, axis=-1, keepdims=True) / self.reach**2)
        force: FloatArray = np.array(self.push) - self.stiffness * x - self.damping * p
        return force


class _Motion:
    """The solution of y' = F(y) through y(0), as far as it was asked for; pieces are kept."""

    def __init__(self, rate: Callable[[FloatArray], FloatArray], start: FloatArray, units: FloatArray, time: float):
        self._rate, self._start, self._units, self._piece = rate, start, units, _PIECE * time
        self._pieces: dict[bool, list[Any]] = {True: [], False: []}

    def at(self, t: float) -> FloatArray:
        """y(t)."""
        ahead, k = t >= 0.0, int(abs(t) // self._piece)
        pieces = self._pieces[ahead]
        while len(pieces) <= k:
            pieces.append(self._next(ahead, pieces))
        y: FloatArray = pieces[k](t)
        return y

    def _next(self, ahead: bool, pieces: list[Any]) -> Any:
        from scipy.integrate import solve_ivp

        ends = np.array([len(pieces), len(pieces) + 1]) * (self._piece if ahead else -self._piece)
        start = pieces[-1](ends[0]) if pieces else self._start
        done = solve_ivp(
            lambda _, y: self._rate(y),
            tuple(ends.tolist()),
            start,
            method="DOP853",
            dense_output=True,
            rtol=_RTOL,
            atol=1e-13 * self._units,
        )
        if not (done.success and np.isfinite(done.y).all()):
            raise SolverError(
                f"the γ-agent's own motion cannot be integrated beyond t = {done.t[-1]:.6g} ({done.message}): expected "
                "a force f_r(q_r, p_r) that keeps it finite"
            )
        return done.sol


def _accelerations(force: Force, q: FloatArray, p: FloatArray) -> FloatArray:
    """f_r of one place, or of each of several: a function of a user's own is asked for one at a time."""
    if q.ndim == 1 or isinstance(force, Spring):
        return np.asarray(force(q, p), dtype=np.float64)
    return np.array([force(*each) for each in zip(q, p, strict=True)], dtype=np.float64)


def _motion(q: FloatArray, p: FloatArray, time: float, acceleration: Force) -> _Motion:
    """The motion of (q, p), of any shape, under an acceleration; its first value is checked."""
    with np.errstate(all="ignore"):
        first = acceleration(q, p)
    if first.shape != q.shape or not np.isfinite(first).all():
        raise ArgumentError(f"force gives {first!r} at the start: expected {q.shape[-1]} finite components")
    length = max(float(np.abs(x).max()) * time**k for k, x in enumerate((q, p, first))) or 1.0
    units = np.repeat([length, length / time], q.size)

    def rate(y: FloatArray) -> FloatArray:
        x, v = y.reshape(2, *q.shape)
        return np.concatenate([v.ravel(), acceleration(x, v).ravel()])

    return _Motion(rate, np.concatenate([q.ravel(), p.ravel()]), units, time)


def _ensure_force(force: Any) -> None:
    if not callable(force):
        raise ArgumentError(f"force = {force!r}: expected Spring(...) or a function (q_r, p_r) -> p_r'")


def _force_in_units(force: Any, length: float, time: float) -> Any:
    """f_r in other units: by its table of powers, or a user's function of what it was."""
    if is_dataclass(force):
        return rescale(force, length=length, time=time)

    def scaled(q: FloatArray, p: FloatArray) -> FloatArray:
        own: FloatArray = np.asarray(force(q / length, p * (time / length)), dtype=np.float64)
        return own * (length / time**2)

    return scaled


@dataclass(frozen=True)
class SystemTarget(Target):
    """A γ-agent that is a system, q_r' = p_r, p_r' = f_r(q_r, p_r), from (q, p) at t = 0   (Olfati-Saber 2006).

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
        q = ensure_vector("q", self.q)
        object.__setattr__(self, "q", tuple(q.tolist()))
        object.__setattr__(self, "p", tuple(ensure_vector("p", self.p, q.size).tolist()))
        object.__setattr__(self, "time", ensure_positive("time", self.time))
        _ensure_force(self.force)
        _ = self._motion

    @cached_property
    def _motion(self) -> _Motion:
        return _motion(np.array(self.q), np.array(self.p), self.time, lambda q, p: _accelerations(self.force, q, p))

    def in_units(self, length: float, time: float) -> SystemTarget:
        """The same motion in other units (`flockana.rescale`).

        Parameters
        ----------
        length, time : float
            Factors.
        """
        q, p = np.array(self.q) * length, np.array(self.p) * (length / time)
        return replace(self, q=q, p=p, force=_force_in_units(self.force, length, time), time=self.time * time)

    def position(self, t: float) -> FloatArray:  # noqa: D102
        return self._motion.at(float(t))[: len(self.q)]

    def rate(self, t: float) -> FloatArray:  # noqa: D102
        return self._motion.at(float(t))[len(self.q) :]

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        y = self._motion.at(float(t))
        return y[: len(self.q)], y[len(self.q) :]


@dataclass(frozen=True)
class Copies:
    """A copy of the γ-agent for each agent, each an estimate of its own that obeys f_r, coupled to the others or not.

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
        for name in ("position_coupling", "velocity_coupling"):
            object.__setattr__(self, name, ensure_nonnegative(name, getattr(self, name)))
        object.__setattr__(self, "time", ensure_positive("time", self.time))
        _ensure_force(self.force)
        _ = self._motion

    @property
    def shape(self) -> tuple[int, int]:
        """(n, m)."""
        return len(self.q), len(self.q[0])

    @cached_property
    def _motion(self) -> _Motion:
        k1, k2 = self.position_coupling, self.velocity_coupling

        def acceleration(q: FloatArray, p: FloatArray) -> FloatArray:
            coupled = k1 * (q.mean(axis=0) - q) + k2 * (p.mean(axis=0) - p)
            pushed: FloatArray = _accelerations(self.force, q, p) + coupled
            return pushed

        return _motion(np.array(self.q), np.array(self.p), self.time, acceleration)

    def in_units(self, length: float, time: float) -> Copies:
        """The same motion in other units (`flockana.rescale`).

        Parameters
        ----------
        length, time : float
            Factors.
        """
        return replace(
            self,
            q=np.array(self.q) * length,
            p=np.array(self.p) * (length / time),
            force=_force_in_units(self.force, length, time),
            position_coupling=self.position_coupling / time**2,
            velocity_coupling=self.velocity_coupling / time,
            time=self.time * time,
        )

    def state(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Places and velocities of all copies, two arrays (n, m).

        Parameters
        ----------
        t : float
            Time.
        """
        both: FloatArray = self._motion.at(float(t)).reshape(2, *self.shape)
        return both[0], both[1]
