"""Adaptive solvers, step by step: no encounter leapt over, the energy balanced, every switch located.

Those that are compiled take the laws that are (`flockana.dynamics.compiled`), scipy's all the others.

Beside the state, ∫ dH/dt is integrated as one more variable.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from functools import cache

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.compiled import engine_of, stepped
from flockana.dynamics.encounters import Encounters
from flockana.dynamics.sample import Sample, Samples, Tally, finite, has_energy
from flockana.dynamics.stepping import ONE_STEP, Balance, Check, EncounterCheck, FiniteEnergy, Flow, Frame, Stepper
from flockana.dynamics.switches import Switches
from flockana.dynamics.tolerance import Control
from flockana.kernels.advance import TOO_SMALL
from flockana.laws.law import Law
from flockana.laws.switched import SwitchedLaw

SCIPY = "scipy-"  # what the name of a method begins with if it is to be scipy's in any case


def adaptive(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    control: Control,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample | Samples]:
    """Samples and steps of a run, each kept as soon as it is made.

    A step that leaps over an encounter, or (with a method that has no past) breaks the energy's balance by more
    than the relative tolerance of it, is made again, and shorter. A law with jumps is integrated from switch to switch;
    one that slides ends the run. `tally.notes` gets the numbers of steps made again and of switches.
    """
    switches = Switches(law, q0) if isinstance(law, SwitchedLaw) and law.located else None
    engine = None if switches is not None else engine_of(law, q0, p0, t_span[0], method, control)
    if engine is None:
        yield from _by_scipy(law, q0, p0, t_span, method.removeprefix(SCIPY), control, keep, tally, switches)
        return
    ends, due = np.array([t_span[1]]), np.empty(0) if keep is None else keep
    yield from stepped(engine, q0, p0, ends, due, keep, tally, lambda *at: _gave_up(method, *at))


def _by_scipy(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    control: Control,
    keep: FloatArray | None,
    tally: Tally,
    switches: Switches | None,
) -> Iterator[Sample]:
    """The same by one of scipy's solvers, stepped as `solve_ivp` does."""
    flow: Flow = law.flow if switches is None else switches.flow
    frame = Frame.of(t_span[0], q0, p0, energetic=has_energy(law, t_span[0], q0, p0))
    solver = _solver(frame, _counted(flow, tally, method), q0, p0, t_span, method, control)
    checks = _checks(law, frame, method, control) if switches is None else ()

    def work(y: FloatArray) -> dict[str, FloatArray]:
        return {"work": np.array(y[-1])} if frame.energetic else {}

    def sample(t: float, y: FloatArray) -> Sample:
        q, p = frame.state(t, y)
        return Sample(t, q, p, flow(t, q, p)[0], work(y))

    t, due, beside = t_span[0], deque([] if keep is None else keep.tolist()), None
    if keep is None or due[0] == t:
        yield Sample(t, q0, p0, flow(t, q0, p0)[0], work(np.zeros(1)))  # not a rounding beside it, as in the frame
        _drop(due, t)
    if switches is not None:
        tally.notes["switches"] = 0
    while t < t_span[1]:
        if not solver.step(checks):
            tally.fail(solver.message)
            return
        tally.steps += 1
        course, now = cache(solver.course), solver.now
        reached, switch = Sample(now.t, *now.state, work(now.y)), None
        if switches is None:
            tally.notes["redone"] = solver.redone
        else:
            switch = switches.first(lambda s, course=course: frame.state(s, course()(s))[0], t, now.t)  # type: ignore[misc]
        if switch is not None:
            reached = sample(switch, course()(switch))
        t = reached.t
        if beside is not None and beside.t < (min(t, due[0]) if due else t):
            yield beside
        beside = None
        while due and due[0] < t:
            yield sample(due[0], course()(due[0]))
            due.popleft()
        yield reached._replace(wanted=_drop(due, t) or keep is None)
        if switches is None or switch is None:
            continue
        sliding = switches.cross(t, reached.q, reached.p)
        tally.notes["switches"] = switches.count
        if sliding is not None:
            tally.notes["sliding"] = sliding
            tally.fail(f"sliding at t = {t:.6g}: {sliding}")
            return
        y = course()(switch)
        solver.begin(_counted(flow, tally, method), t, y)
        beside = _beside(sample(t, y))


def _gave_up(method: str, status: int, t: float) -> str:
    """Why a compiled run ended early, in the words of scipy's solvers."""
    small = "Required step size is less than spacing between numbers."
    return f"{method} gave up at t = {t:g}: {small if status == TOO_SMALL else 'the state is no longer finite'}"


def _drop(due: deque[float], t: float) -> bool:
    """Whether a sample was due at this time; it no longer is."""
    return bool(due) and due[0] == t and due.popleft() == t


def _beside(switch: Sample) -> Sample:
    """The path goes on from a switch with the other side's input: a knot next to it, apart in any unit of time."""
    gap = 4.0 * float(np.spacing(abs(switch.t)))
    return switch._replace(t=switch.t + gap, q=switch.q + gap * switch.p, wanted=False)


def _solver(
    frame: Frame,
    flow: Flow,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    control: Control,
) -> Stepper:
    """One of scipy's solvers at the start of a run."""
    sizes = (frame.size, frame.size, int(frame.energetic))
    atol = np.concatenate([np.full(size, value) for size, value in zip(sizes, control.floor, strict=True)])
    return Stepper(method, frame, flow, t_span[0], frame.start(q0, p0), t_span[1], control=control, atol=atol)


def _checks(law: Law, frame: Frame, method: str, control: Control) -> tuple[Check, ...]:
    """What every step of a law without jumps must stand up to."""
    encounters = Encounters.of(law, frame.shape[0])
    checks: list[Check] = [EncounterCheck(encounters)] if encounters.any else []
    if frame.energetic:
        checks.append(Balance(law, control.rtol, control.floor.work) if method in ONE_STEP else FiniteEnergy(law))
    return tuple(checks)


def _counted(flow: Flow, tally: Tally, method: str) -> Flow:
    """A flow that counts its evaluations, and stops a solver that would not notice that it is no longer finite."""

    def evaluated(t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        tally.evaluations += 1
        u, rate = flow(t, q, p)
        if method == "LSODA" and not finite(u):  # LSODA would try to step over it for ever
            raise FloatingPointError(f"the law's acceleration is not finite at t = {t:g}")
        return u, rate

    return evaluated
