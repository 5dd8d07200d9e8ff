"""One of scipy's solvers, step by step; a step that leapt over something is made again, and shorter.

The state is one vector: positions and velocities relative to the mean motion of the start, and ∫ dH/dt. So a relative
tolerance is relative to nothing that a choice of the origin, or of an inertial frame, would change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.dynamics.encounters import Encounters, State, at_a_pole
from flockana.dynamics.tolerance import Control
from flockana.kernels.advance import FALLS, HALVINGS, HELPS, PATIENCE, ROUNDINGS
from flockana.laws.law import Law

Flow = Callable[[float, FloatArray, FloatArray], tuple[FloatArray, float]]

ONE_STEP = ("DOP853", "RK45", "RK23", "Radau")  # without a past: what they do next hangs on the state alone
BALANCED = 0.05  # of the relative tolerance: residual of the energy's balance that a step may leave, over |H|


@dataclass(frozen=True, eq=False)
class Frame:
    """States as vectors relative to the mean motion of the start.

    Parameters
    ----------
    t0 : float
        Time of the start.
    origin, drift : ndarray, shape (N,)
        The vector of the mean motion at t0, and its rate.
    shape : (int, int)
        (n, m).
    energetic : bool
        Whether ∫ dH/dt is the vector's last component.
    """

    t0: float
    origin: FloatArray
    drift: FloatArray
    shape: tuple[int, int]
    energetic: bool

    @classmethod
    def of(cls, t0: float, q0: FloatArray, p0: FloatArray, *, energetic: bool) -> Frame:
        """That of a start."""
        place, velocity = (np.tile(x.mean(axis=0), len(x)) for x in (q0, p0))
        rest = np.zeros(int(energetic))
        origin, drift = np.concatenate([place, velocity, rest]), np.concatenate([velocity, 0.0 * place, rest])
        return cls(t0, origin, drift, (q0.shape[0], q0.shape[1]), energetic)

    @property
    def size(self) -> int:
        """Number of positions."""
        return self.shape[0] * self.shape[1]

    def start(self, q0: FloatArray, p0: FloatArray) -> FloatArray:
        """The vector of the start."""
        y0: FloatArray = np.concatenate([q0.ravel(), p0.ravel(), np.zeros(int(self.energetic))]) - self.origin
        return y0

    def state(self, t: float, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(q, p) of a vector."""
        whole = y + (self.origin + self.drift * (t - self.t0))
        both = whole[: 2 * self.size].reshape(2, *self.shape)
        return both[0], both[1]

    def input(self, f: FloatArray) -> FloatArray:
        """The accelerations in a rate of the vector."""
        return f[self.size : 2 * self.size].reshape(self.shape)

    def rate(self, flow: Flow) -> Callable[[float, FloatArray], FloatArray]:
        """The right-hand side of the vector."""
        size, energetic = self.size, self.energetic

        def rhs(t: float, y: FloatArray) -> FloatArray:
            u, rate = flow(t, *self.state(t, y))
            return np.concatenate([y[size : 2 * size], u.ravel(), [rate] if energetic else []])

        return rhs


class Moment(NamedTuple):
    """An instant of a run: the solver's vector, and the positions, velocities and accelerations in it."""

    t: float
    y: FloatArray
    state: State


class Check(Protocol):
    """Something to hold a step against."""

    def share(self, before: Moment, after: Moment) -> float:
        """Return how much of a step may be taken: 1 if it stands, negative if it crossed a pole."""


@dataclass(frozen=True, eq=False)
class EncounterCheck:
    """The check that no encounter is leapt over.

    Parameters
    ----------
    encounters : Encounters
        Of the law.
    """

    encounters: Encounters

    def share(self, before: Moment, after: Moment) -> float:
        """How much of a step may be taken."""
        return self.encounters.share(after.t - before.t, before.state, after.state)


class Balance:
    """The check that each step keeps H(t) − ∫ dH/dt: an error estimate may miss a kink of the force, this does not.

    A residual that does not fall when the step is halved is no integrator's: the law's rate is not that of its energy,
    or all is rounding. Then steps stand as they are.

    Parameters
    ----------
    law : Law
        With an energy.
    rtol : float
        Relative tolerance of the run; a twentieth of it, times the largest |H| so far, is what a step may be off by.
    floor : float
        Energy of which the same share is allowed in any case.
    """

    def __init__(self, law: Law, rtol: float, floor: float) -> None:
        self.law, self.share_of_energy, self.floor = law, BALANCED * rtol, BALANCED * floor
        self._known, self._largest = (np.nan, 0.0), 0.0  # (time, H) where the step began; the largest |H|
        self._tried: list[float] = []  # residuals of the steps from here that were halved
        self._in_vain = 0  # steps in a row for which halving did nothing

    def share(self, before: Moment, after: Moment) -> float:
        """How much of a step may be taken."""
        if self._in_vain == PATIENCE:
            return 1.0
        first = self._known[1] if self._known[0] == before.t else self._energy(before)
        last = self._energy(after)
        if np.isfinite(first) and not np.isfinite(last):  # the step ends where the potential is infinite
            self._known = (before.t, first)
            return -0.5
        residual = abs(last - first - float(after.y[-1] - before.y[-1]))
        largest = max(self._largest, abs(first), abs(last))
        off, tried = residual > max(self.share_of_energy * largest, self.floor), self._tried
        if off and (len(tried) < HALVINGS or residual <= FALLS * max(tried[: 1 - HALVINGS])):
            self._known, self._tried = (before.t, first), [*tried, residual]
            return 0.5
        if tried:
            helped = residual <= tried[0] * HELPS ** len(tried)
            self._in_vain = 0 if helped else self._in_vain + 1
        self._known, self._largest, self._tried = (after.t, last), largest, []
        return 1.0

    def _energy(self, moment: Moment) -> float:
        return self.law.hamiltonian(moment.t, moment.state.q, moment.state.p)


@dataclass(frozen=True, eq=False)
class FiniteEnergy:
    """The check that no step ends where the potential is infinite.

    Parameters
    ----------
    law : Law
        With an energy.
    """

    law: Law

    def share(self, before: Moment, after: Moment) -> float:
        """Return 1, or a half, negative, for a step that crossed a pole."""
        return 1.0 if np.isfinite(self.law.hamiltonian(after.t, after.state.q, after.state.p)) else -0.5


class Stepper:
    """A solver that steps a law; every step stands up to all checks, or is made again with the share that they allow.

    Parameters
    ----------
    method : str
        One of scipy's solvers.
    frame : Frame
        Of the vectors.
    flow : callable
        ``flow(t, q, p) -> (u, dH/dt)``.
    t, end : float
        Start and end.
    y : ndarray, shape (N,)
        The start.
    control : Control
        Relative tolerance and longest step.
    atol : ndarray, shape (N,)
        Absolute tolerances.
    """

    def __init__(
        self,
        method: str,
        frame: Frame,
        flow: Flow,
        t: float,
        y: FloatArray,
        end: float,
        *,
        control: Control,
        atol: FloatArray,
    ) -> None:
        self.method, self.frame, self.end, self.atol = method, frame, end, atol
        self.rtol, self.longest = control.rtol, control.longest
        self.redone, self.message = 0, ""
        self.begin(flow, t, y)

    def begin(self, flow: Flow, t: float, y: FloatArray) -> None:
        """Go on from here, with another flow."""
        self._rhs = self.frame.rate(flow)
        self._open(t, y, self.end, None)
        self.now = self._moment()

    def _open(self, t: float, y: FloatArray, until: float, first: float | None) -> None:
        """A new solver from here until some time, whose first step is as long as that if it can be."""
        import scipy.integrate

        options: dict[str, Any] = {"rtol": self.rtol, "atol": self.atol, "max_step": self.longest}
        if first is not None and self.method in ONE_STEP:
            options["first_step"] = min(first, until - t, self.longest)
        self._solver = getattr(scipy.integrate, self.method)(self._rhs, t, y, until, **options)

    def _moment(self) -> Moment:
        """Where the solver is; most know the rate there."""
        t, y, f = float(self._solver.t), self._solver.y, getattr(self._solver, "f", None)
        if f is None:
            f = self._rhs(t, y)
        return Moment(t, y, State(*self.frame.state(t, y), self.frame.input(f).copy()))

    @property
    def done(self) -> bool:
        """Whether the end is reached."""
        return self.now.t >= self.end

    def step(self, checks: tuple[Check, ...]) -> bool:
        """One step that stands, to a new `now`; False if the solver gives up, for the reason in `message`."""
        start = self.now
        while True:
            if self._solver.status == "finished":  # a step that was made again ended here
                self._open(start.t, start.y, self.end, getattr(self._solver, "h_abs", None))
            reached = self._attempt()
            if reached is None:
                return False
            if reached.t <= start.t:
                self.message = f"{self.method} gave up at t = {start.t:g}: its step is lost in the rounding of the time"
                return False
            h, shortest = reached.t - start.t, ROUNDINGS * float(np.spacing(max(abs(start.t), abs(reached.t))))
            share = next((share for check in checks if (share := check.share(start, reached)) < 1.0), 1.0)
            singular, share = share < 0.0, abs(share)
            if singular and share * h <= shortest:
                self.message = at_a_pole(start.t)
                return False
            if share == 1.0 or share * h <= shortest:
                self.now = reached
                return True
            self.redone += 1
            self._open(start.t, start.y, start.t + share * h, share * h)

    def _attempt(self) -> Moment | None:
        """One step of the solver as it comes."""
        try:
            message = self._solver.step()
            if self._solver.status != "failed" and np.isfinite(self._solver.y).all():
                reached = self._moment()
                if np.isfinite(reached.state.u).all():
                    return reached
            self.message = message or "the state is no longer finite"
        except (ValueError, FloatingPointError, np.linalg.LinAlgError) as error:  # implicit solvers raise on NaN
            if isinstance(error, ArgumentError):
                raise
            self.message = str(error)
        self.message = f"{self.method} gave up at t = {self._solver.t:g}: {self.message}"
        return None

    def course(self) -> Callable[[float], FloatArray]:
        """The interpolant of the last step."""
        return self._solver.dense_output()  # type: ignore[no-any-return]
