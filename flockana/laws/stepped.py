"""Steps of a wrapped law: Euler-Maruyama, a weak scheme of order 2, and Runge-Kutta of order 4 over the past."""

from collections import deque
from dataclasses import dataclass
from functools import cached_property, partial
from math import ceil, isclose
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray, ensure_fits, ensure_kind
from flockana.base.errors import ArgumentError
from flockana.kernels.euler_maruyama import euler_maruyama_steps
from flockana.kernels.verlet import no_pairs, with_room
from flockana.laws.delayed import Delayed
from flockana.laws.discrete import IndexArray, States
from flockana.laws.disturbed import Disturbed
from flockana.laws.law import Arrays
from flockana.laws.scheme import Scheme
from flockana.laws.wrapped import Step, View, Wrapper, input_of

ORDERS = (1, 2, 4)
_WHOLE = 1e-9  # relative: how far from a whole number of steps a clock may be
_Kicking = list[Wrapper]
_Made = tuple[FloatArray, FloatArray, FloatArray, FloatArray]  # q, p, u that arrived, u that departs
_Past = deque[tuple[FloatArray, FloatArray, FloatArray, FloatArray]]  # q, p, u that arrives, u that departs


@dataclass(frozen=True)
class Stepped(Scheme):
    """A wrapped law in fixed steps, as `simulate(law, ..., dt=)` runs it.

    Order 1 is Euler-Maruyama: q' = q + h p + ½ h² u, p' = p + h u + Δw, exact where the input is held. It is compiled
    where the law within is and all that is around it are pushes. Order 2 is Heun's scheme, with noise that is added a
    weak one of order 2. Order 4 is the classical Runge-Kutta scheme, of laws without noise; the past between steps is a
    Hermite cubic. Steps must divide delays and sampling periods.

    Parameters
    ----------
    order : {1, 2, 4}
        Scheme.
    """

    order: int = 2

    steps_at_once = 512
    private = ("step", "past", "held")

    def __post_init__(self) -> None:
        ensure_kind("law", self.law, Wrapper, "a law that wraps one, such as Disturbed(law, ...)")
        super().__post_init__()
        dt = self.dt
        if self.order not in ORDERS:
            raise ArgumentError(f"order = {self.order!r}: expected one of 1, 2, 4")
        for clock in (clock for one in self._wrappers for clock in one.clocks):
            if clock / dt < 1.0 - _WHOLE or not isclose(clock / dt, round(clock / dt), rel_tol=_WHOLE):
                raise ArgumentError(
                    f"dt = {dt:g}: expected a step that divides the delay or period {clock:g}, such as "
                    f"{clock / max(1, ceil(clock / dt)):.12g}"
                )
        for late in self._late:
            late._ensure_remembered(self._memory)
        if self.order == 4 and self.noisy:
            raise ArgumentError("order = 4: noise is stepped with order 1 or 2; expected one of them")

    @property
    def noisy(self) -> bool:
        """Whether the law draws random numbers."""
        return any(one.noisy for one in self._wrappers)

    @cached_property
    def _wrappers(self) -> tuple[Wrapper, ...]:
        return tuple(self.law.wrappers) if isinstance(self.law, Wrapper) else ()

    @cached_property
    def _late(self) -> tuple[Delayed, ...]:
        return tuple(one for one in self._wrappers if isinstance(one, Delayed))

    @cached_property
    def _memory(self) -> float:
        """Longest time that the law looks back: delays within each other add up."""
        return sum(one.memory for one in self._wrappers)

    @cached_property
    def past_steps(self) -> int:
        """Steps of the past that are kept, the present one among them."""
        return 2 + ceil(self._memory / self.dt - _WHOLE) if self._memory > 0.0 else 0

    def check_agents(self, n: int) -> None:  # noqa: D102
        self.law.check_agents(n)

    def start(self, q: FloatArray, p: FloatArray) -> Arrays:
        """Return the past: the history of a delayed law, else a motion with the initial velocities."""
        rows = (self.past_steps, *q.shape)
        ensure_fits("the past of a delay", (4, *rows), "take a shorter delay or longer steps")
        past = np.empty((0, 4, *q.shape))
        if self.past_steps:
            with_history = next((one for one in self._late if one.history_t is not None), self._late[0])
            before, speeds, push = with_history._past(self.dt * np.arange(1.0 - self.past_steps, 1.0), q, p)
            past = np.stack([before, speeds, push, push], axis=1)
        return {"step": np.array(0.0), "past": past, "held": np.empty((0, *q.shape))}

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:  # noqa: D102
        q, p, u, after = self.iterate(t, q, p, memory, 1)
        return q[0], p[0], u[0], {name: values[-1] for name, values in after.items()}

    def iterate(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, steps: int) -> States:  # noqa: D102
        return self.visit(t, q, p, memory, np.arange(1, steps + 1))

    def visit(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray) -> States:  # noqa: D102
        if self.order == 1 and (made := self._marched(t, q, p, int(memory["step"]), wanted)) is not None:
            return made
        shape, advance = q.shape, {1: self._euler, 2: self._heun, 4: self._runge_kutta}[self.order]
        past: _Past = deque([tuple(row) for row in memory["past"]], maxlen=self.past_steps or 1)
        first = int(memory["step"])
        held = {k: one for k, one in enumerate(memory["held"], start=1) if np.isfinite(one).all()}
        now = Step(first, self.dt, lambda _: (q, p), held)
        kicking = [one for one in self._wrappers if type(one).kick is not Wrapper.kick]
        marks, kept, row = set(wanted.tolist()), np.empty((3, len(wanted), *shape)), 0
        for k in range(int(wanted[-1])):
            now.number, now.begins, at = first + k, True, t + k * self.dt
            if past and self.past_steps:
                now.past = partial(_past_state, past, at, self.dt)
            q, p, u, departs = advance(now, at, q, p, kicking, past)
            if self.past_steps:
                past.append((q, p, departs, departs))
            if k + 1 in marks:
                kept[:, row] = q, p, u
                row += 1
        depth = len(self._wrappers)
        stored = np.full((depth, *shape), np.nan)
        for key, value in now.held.items():
            stored[key - 1] = value
        after = {"step": np.array(float(first + int(wanted[-1]))), "held": stored}
        after["past"] = np.array(past) if self.past_steps else np.empty((0, 4, *shape))
        return kept[0], kept[1], kept[2], {name: value[None] for name, value in after.items()}

    def _marched(self, t: float, q: FloatArray, p: FloatArray, first: int, wanted: IndexArray) -> States | None:
        """Return the result of `visit` from one compiled call; None if the law is not compiled or has more wrappers."""
        law, (n, m), steps = self.law, q.shape, int(wanted[-1])
        pushing = [one for one in self._wrappers if isinstance(one, Disturbed)]
        if not isinstance(law, Disturbed) or len(pushing) < len(self._wrappers):
            return None
        if (form := law.compiled_push(m)) is None or law.obstacle_field is not None:
            return None
        system = form.system((t, np.zeros(m), np.zeros(m)), n, m)
        kicks = sum((one._kicks(first, steps, self.dt, (n, m)) for one in pushing), np.zeros((steps, n, m)))
        start, out = np.concatenate([q.ravel(), p.ravel(), [0.0]]), np.empty((3, len(wanted), n, m))
        pairs, given = no_pairs(n, m), (kicks.reshape(steps, n * m), np.asarray(wanted), system)
        while not euler_maruyama_steps(t, self.dt, start.copy(), *given, pairs, out):
            if (larger := with_room(pairs)) is None:
                return None
            pairs = larger
        held, past = np.full((1, len(self._wrappers), n, m), np.nan), np.empty((1, 0, 4, n, m))
        return out[0], out[1], out[2], {"step": np.array([float(first + steps)]), "held": held, "past": past}

    def _ask(self, now: Step, t: float, q: FloatArray, p: FloatArray) -> FloatArray:
        return input_of(self.law, now, View(t, q, p))

    def _begin_step(self, now: Step, t: float, q: FloatArray, p: FloatArray, past: _Past) -> FloatArray:
        """Return the input at the step's beginning, and store it in the past."""
        u = self._ask(now, t, q, p)
        now.begins = False
        if self.past_steps:
            last = past.pop()
            past.append((last[0], last[1], u if now.number else last[2], u))  # it jumps at the start
        return u

    def _euler(self, now: Step, t: float, q: FloatArray, p: FloatArray, kicking: _Kicking, past: _Past) -> _Made:
        u, h = self._begin_step(now, t, q, p, past), self.dt
        after = p + h * u
        return q + (0.5 * h) * (p + after), _kicked(after, now, kicking), u, u

    def _heun(self, now: Step, t: float, q: FloatArray, p: FloatArray, kicking: _Kicking, past: _Past) -> _Made:
        first, h = self._begin_step(now, t, q, p, past), self.dt
        guess = _kicked(p + h * first, now, kicking)
        second = self._ask(now, t + h, q + h * p, guess)
        u = 0.5 * (first + second)
        return q + (0.5 * h) * (p + guess), p + h * u + (guess - p - h * first), u, second

    def _runge_kutta(self, now: Step, t: float, q: FloatArray, p: FloatArray, kicking: _Kicking, past: _Past) -> _Made:
        k1, h = self._begin_step(now, t, q, p, past), self.dt
        k2 = self._ask(now, t + h / 2, q + h / 2 * p, p + h / 2 * k1)
        k3 = self._ask(now, t + h / 2, q + h / 2 * (p + h / 2 * k1), p + h / 2 * k2)
        k4 = self._ask(now, t + h, q + h * (p + h / 2 * k2), p + h * k3)
        u = (k1 + 2.0 * (k2 + k3) + k4) / 6.0
        return q + h * p + h * h / 6.0 * (k1 + k2 + k3), p + h * u, u, k4


def _kicked(p: FloatArray, now: Step, kicking: list[Wrapper]) -> FloatArray:
    """Velocities after the white noise of a step."""
    for one in kicking:
        kick = one.kick(now, p.shape)
        p = p if kick is None else p + kick
    return p


def _past_state(past: _Past, t: float, h: float, s: float) -> tuple[FloatArray, FloatArray]:
    """Return the state at an earlier time s: steps that were made, and between two a Hermite cubic."""
    back, last = (t - s) / h, len(past) - 1
    k = min(last, max(0, ceil(back - _WHOLE)))
    share = k - back  # of the interval that begins k steps ago
    q0, p0, _, u0 = past[last - k]
    if abs(share) <= _WHOLE or k == 0:
        return q0, p0
    q1, p1, u1, _ = past[last - k + 1]
    return _hermite(q0, p0, q1, p1, share, h), _hermite(p0, u0, p1, u1, share, h)


def _hermite(x0: Any, v0: Any, x1: Any, v1: Any, share: float, h: float) -> FloatArray:
    a, b = share * share * (3.0 - 2.0 * share), share * (1.0 - share)
    return x0 + a * (x1 - x0) + h * b * ((1.0 - share) * v0 - share * v1)
