"""How a law is stepped: scipy's adaptive solvers, classical RK4, the steps of a map; each yields samples as it goes.

Beside the state, ∫ dH/dt is integrated as one more variable.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.scales import Scales
from flockana.dynamics.encounters import Encounters, State
from flockana.dynamics.stepping import ONE_STEP, Balance, Check, Flow, Frame, Meetings, Moment, Stepper
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.law import Law

FLOOR = 1e-2  # of the relative tolerance: the default absolute one, over the law's scales
FINEST = 3e-14  # relative tolerance below which the solvers cannot go
_ROUNDINGS = 1.0  # of the largest coordinate, at that tolerance: what a force makes of rounded places is noise
_COARSER = 0.25  # power of the tolerance by which more is allowed: runs at two tolerances differ, and so tell the error


class Sample(NamedTuple):
    """One instant of a run: a sample, or if it is not `wanted` a step that the integrator made between samples."""

    t: float
    q: FloatArray
    p: FloatArray
    u: FloatArray
    extra: dict[str, FloatArray]
    wanted: bool = True


@dataclass
class Tally:
    """What a run did, filled in as it goes, so that an interrupted run can tell.

    Parameters
    ----------
    evaluations, steps : int
        Counts of right-hand sides and of steps.
    status, message : str
        As in `Trajectory`.
    notes : dict
        What else an integrator has to tell, for `Trajectory.stats`.
    """

    evaluations: int = 0
    steps: int = 0
    status: str = "complete"
    message: str = "reached the end of the time span"
    notes: dict[str, Any] = field(default_factory=dict)

    def fail(self, message: str) -> None:
        """Note that the run ended early, and why."""
        self.status, self.message = "failed", message


def start_sample(law: Law | DiscreteLaw, q0: FloatArray, p0: FloatArray, t0: float) -> Sample:
    """The initial state as a sample."""
    if isinstance(law, DiscreteLaw):
        return Sample(t0, q0, p0, np.zeros_like(q0), _copied(law.start(q0, p0)))
    extra = {"work": np.array(0.0)} if has_energy(law, t0, q0, p0) else {}
    return Sample(t0, q0, p0, law.flow(t0, q0, p0)[0], extra)


def _copied(memory: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    return {name: np.array(value) for name, value in memory.items()}


def _finite(*values: Any) -> bool:
    return all(bool(np.isfinite(value).all()) for value in values)


def has_energy(law: Law, t: float, q: FloatArray, p: FloatArray) -> bool:
    """Whether a law has an energy, so that its work can be integrated."""
    return bool(np.isfinite(law.hamiltonian(t, q, p)))


class Floor(NamedTuple):
    """Errors that are always allowed, whatever the state: of a position, a velocity, and the work."""

    length: float
    speed: float
    energy: float


def error_floor(
    law: Law, q0: FloatArray, p0: FloatArray, t_span: tuple[float, float], rtol: float, atol: float | None
) -> Floor:
    """Absolute tolerances: the same number for all, or by default a hundredth of `rtol` times the law's own scales.

    A law without scales is measured by the extent of its start and by the duration. Work is measured against the energy
    that it is the change of, not against zero, where it starts. Far from the origin places are known to their rounding
    only, and forces to what it makes of them: nothing below that can be asked for.
    """
    scales = law.scales
    if scales is None:
        duration = t_span[1] - t_span[0]
        extent, travel = (float(np.abs(x - x.mean(axis=0)).max()) for x in (q0, p0 * duration))
        scales = Scales(extent or travel or float(np.abs(p0).max()) * duration or 1.0, duration)
    share = FLOOR * rtol
    floor = (share * scales.length, share * scales.speed, share * len(q0) * scales.energy)
    length, speed, energy = floor if atol is None else (atol,) * 3
    reach = float(np.abs(q0).max() + np.abs(p0.mean(axis=0)).max() * (t_span[1] - t_span[0]))
    blur = _ROUNDINGS * (rtol / FINEST) ** _COARSER * float(np.spacing(reach)) / scales.length
    length, speed = max(length, blur * scales.length), max(speed, blur * scales.speed)
    energy = max(energy, blur * len(q0) * scales.energy)
    start = law.hamiltonian(t_span[0], q0, p0)
    return Floor(length, speed, max(energy, rtol * abs(start)) if np.isfinite(start) else energy)


def stepper(
    law: Law,
    flow: Flow,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    rtol: float,
    floor: Floor,
    tally: Tally,
) -> Stepper:
    """One of scipy's solvers at the start of a run, counting evaluations."""
    frame = Frame.of(t_span[0], q0, p0, energetic=has_energy(law, t_span[0], q0, p0))
    sizes = (frame.size, frame.size, int(frame.energetic))
    atol = np.concatenate([np.full(size, value) for size, value in zip(sizes, floor, strict=True)])
    return Stepper(
        method, frame, counted(flow, tally, method), t_span[0], frame.start(q0, p0), t_span[1], rtol=rtol, atol=atol
    )


def counted(flow: Flow, tally: Tally, method: str) -> Flow:
    """A flow that counts its evaluations, and stops a solver that would not notice that it is no longer finite."""

    def evaluated(t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        tally.evaluations += 1
        u, rate = flow(t, q, p)
        if method == "LSODA" and not _finite(u):  # LSODA would try to step over it for ever
            raise FloatingPointError(f"the law's acceleration is not finite at t = {t:g}")
        return u, rate

    return evaluated


def adaptive(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    rtol: float,
    floor: Floor,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample]:
    """Step one of scipy's solvers, as `solve_ivp` does, but so that each step is kept as soon as it is made.

    A step that leaps over an encounter, or (with a method that has no past) breaks the energy's balance by more than
    `rtol` of it, is made again, and shorter; `tally.notes` gets how many were.
    """
    solver = stepper(law, law.flow, q0, p0, t_span, method, rtol, floor, tally)
    frame, encounters = solver.frame, Encounters.of(law, len(q0))
    checks: list[Check] = [Meetings(encounters)] if encounters.any else []
    if frame.energetic and method in ONE_STEP:
        checks.append(Balance(law, rtol, floor.energy))

    def sample(now: Moment) -> Sample:
        return Sample(now.t, *now.state, {"work": np.array(now.y[-1])} if frame.energetic else {})

    def between(t: float, y: FloatArray) -> Sample:
        q, p = frame.state(t, y)
        return Sample(t, q, p, law.flow(t, q, p)[0], {"work": np.array(y[-1])} if frame.energetic else {})

    wanted = 0
    if keep is None or keep[0] == t_span[0]:
        wanted = 1
        yield start_sample(law, q0, p0, t_span[0])  # not a rounding beside it, as in the frame
    while not solver.done:
        if not solver.step(tuple(checks)):
            tally.fail(solver.message)
            return
        tally.steps += 1
        tally.notes["redone"] = solver.redone
        own, course = sample(solver.now), None
        while keep is not None and wanted < keep.size and keep[wanted] < own.t:
            course = course or solver.course()
            yield between(keep[wanted], course(keep[wanted]))
            wanted += 1
        asked = keep is None or (wanted < keep.size and keep[wanted] == own.t)
        wanted += int(asked)
        yield own._replace(wanted=asked)


_GROWTH = 8.0  # times its last length may a step grow, and by so much it is shortened at once


def rk4(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    dt: float,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample]:
    """Classical RK4 on (q, p, work); steps are shortened to land on the times to keep, and to meet every encounter.

    A step that would leap over an encounter is made again, and shorter: dt is the longest step, and what a step does
    not see is not an error of its order. `tally.notes` gets how many were.
    """
    energetic, encounters = has_energy(law, t_span[0], q0, p0), Encounters.of(law, len(q0))
    t, state, work = t_span[0], State(q0.copy(), p0.copy(), np.empty(0)), 0.0
    u, rate = law.flow(t, q0, p0)
    state = state._replace(u=u)
    tally.evaluations += 1
    tally.notes["redone"], taken = 0, np.inf
    for stop, wanted in _stops(t_span, dt, keep):
        while t < stop:
            remaining = stop - t
            h = remaining if remaining <= _GROWTH * taken else _GROWTH * taken
            while True:
                later, more, rate_there = _rk4_step(law, t, state, rate, h)
                tally.evaluations += 4
                share = encounters.share(h, state, later) if encounters.any and _finite(*later) else 1.0
                if share == 1.0 or t + share * h == t:
                    break
                h *= max(share, 1.0 / _GROWTH)  # what a step that is far too long foresees is no measure of the next
                tally.notes["redone"] += 1
            if not _finite(*later):
                tally.fail(f"RK4 left the finite numbers at t = {t + h:g}: reduce dt = {dt:g}")
                return
            t, taken = (stop, np.inf) if h == remaining else (t + h, h)
            state, rate, work = later, rate_there, work + more
            tally.steps += 1
            if t < stop:
                yield Sample(t, *state, {}, wanted=False)
        yield Sample(t, *state, {"work": np.array(work)} if energetic else {}, wanted=wanted)


def _rk4_step(law: Law, t: float, state: State, rate: float, h: float) -> tuple[State, float, float]:
    """(the state after a step, the work done on the way, dH/dt at the end)."""
    q, p, u = state
    p2 = p + 0.5 * h * u
    u2, rate2 = law.flow(t + 0.5 * h, q + 0.5 * h * p, p2)
    p3 = p + 0.5 * h * u2
    u3, rate3 = law.flow(t + 0.5 * h, q + 0.5 * h * p2, p3)
    p4 = p + h * u3
    u4, rate4 = law.flow(t + h, q + h * p3, p4)
    q = q + h / 6.0 * (p + 2.0 * (p2 + p3) + p4)
    p = p + h / 6.0 * (u + 2.0 * (u2 + u3) + u4)
    work = h / 6.0 * (rate + 2.0 * (rate2 + rate3) + rate4)
    u, rate = law.flow(t + h, q, p)
    return State(q, p, u), work, rate


def count_steps(start: float, stop: float, dt: float, rounded: Callable[[float], float] = np.ceil) -> int:
    """How many steps of dt it takes between two times; the times' own rounding makes none more or less.

    Examples
    --------
    >>> count_steps(0.0, 0.3, 0.1), count_steps(1e6, 1e6 + 0.3, 0.1), count_steps(0.0, 0.31, 0.1)
    (3, 3, 4)
    """
    slack = 4.0 * float(np.spacing(max(abs(start), abs(stop), stop - start)))
    return int(rounded((stop - start + (slack if rounded is np.floor else -slack)) / dt))


def _stops(t_span: tuple[float, float], dt: float, keep: FloatArray | None) -> Iterator[tuple[float, bool]]:
    """Where steps of at most dt end, and whether a sample is wanted there.

    The way to a time to keep is split evenly: a last step that is a sliver would lose the order for nothing.
    """
    if keep is None:
        yield from ((t_span[0] + k * dt, True) for k in range(count_steps(*t_span, dt)))
        yield t_span[1], True
        return
    t = t_span[0]
    for stop in keep.tolist():
        yield from ((one, False) for one in np.linspace(t, stop, max(1, count_steps(t, stop, dt)) + 1)[1:-1].tolist())
        yield stop, True
        t = stop


def discrete(
    law: DiscreteLaw, q0: FloatArray, p0: FloatArray, t_span: tuple[float, float], tally: Tally
) -> Iterator[Sample]:
    """Iterate the map; sample k holds the state at t0 + k dt and the input that brought it there."""
    q, p, memory = q0, p0, law.start(q0, p0)
    yield Sample(t_span[0], q, p, np.zeros_like(q), _copied(memory))
    steps = count_steps(*t_span, law.dt, np.floor)
    for first in range(0, steps, law.steps_at_once):
        some = min(law.steps_at_once, steps - first)
        qs, ps, us, series = law.iterate(t_span[0] + first * law.dt, q, p, memory, some)
        known = np.logical_and(np.isfinite(qs).all(axis=(1, 2)), np.isfinite(ps).all(axis=(1, 2)))
        for k in range(some):
            t = t_span[0] + (first + k + 1) * law.dt
            tally.steps += 1
            tally.evaluations += 1
            if not known[k]:
                tally.fail(f"the map left the finite numbers at t = {t:g}")
                return
            yield Sample(t, qs[k], ps[k], us[k], {name: values[k] for name, values in series.items()})
        # a copy: a law may change its memory in place
        q, p, memory = qs[-1], ps[-1], _copied({name: values[-1] for name, values in series.items()})


def nearest(samples: Iterator[Sample], keep: FloatArray, dt: float) -> Iterator[Sample]:
    """The steps nearest to the wanted times: between its steps a map has no state."""
    wanted = 0
    for sample in samples:
        while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
            yield sample
            wanted += 1
            while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
                wanted += 1  # two wanted times in one step are one sample
