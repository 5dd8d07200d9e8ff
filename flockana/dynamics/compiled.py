"""Runs whose integrator is compiled with the law: many steps in one call (`flockana.kernels.advance`).

What it decides, it decides as the step-by-step integrators do (`adaptive`, `rk4`), which take every law.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.dynamics.encounters import Encounters, at_a_pole
from flockana.dynamics.sample import Sample, Samples, Tally
from flockana.dynamics.stepping import BALANCED, ONE_STEP, Frame
from flockana.dynamics.tolerance import Control, Floors
from flockana.jit import thawed
from flockana.kernels.advance import CROWDED, RUNNING, SINGULAR, Around, Kept, Method, advance
from flockana.kernels.blocks import BLOCK
from flockana.kernels.runge_kutta import System
from flockana.kernels.tableaus import Tableau, tableau
from flockana.kernels.verlet import SKIN, list_pairs
from flockana.laws.law import Law
from flockana.laws.terms.term import Compiled

METHODS = ("DOP853", "RK45", "RK23", "RK4")  # that there are compiled
_STEPS, _NUMBERS = 512, 6_000_000  # in one call, at most: steps, and numbers kept of them
_UNLISTED = "scipy-DOP853"  # which looks at pairs in blocks
EXACT = Control(0.0, Floors(0.0, 0.0, 0.0))


class StepTolerances(NamedTuple):
    """What a step may be off by: by the error's estimate, and (share of the energy, energy) in its balance."""

    control: Control
    balance: tuple[float, float]


class Point(NamedTuple):
    """Where a run is: time, vector, its rate, the next step's length (0 if yet to be chosen)."""

    t: float
    y: FloatArray
    f: FloatArray
    h: float


@dataclass(frozen=True, eq=False)
class Engine:
    """A law and a method, compiled.

    Parameters
    ----------
    law : Law
        With an energy.
    form : Compiled
        The same, compiled.
    frame : Frame
        Of the vectors.
    method : Tableau
        The coefficients.
    encounters : Encounters
        What no step may leap over.
    allowed : StepTolerances
        Tolerances.
    """

    law: Law
    form: Compiled
    frame: Frame
    method: Tableau
    encounters: Encounters
    allowed: StepTolerances

    def start(self, q0: FloatArray, p0: FloatArray) -> tuple[Sample, Point]:
        """The start as a sample and as a point."""
        t0, y0, size = self.frame.t0, self.frame.start(q0, p0), self.frame.size
        u, power = self.law.flow(t0, q0, p0)
        rate = np.concatenate([y0[size : 2 * size], u.ravel(), [power]])
        return Sample(t0, q0, p0, u, {"work": np.array(0.0)}), Point(t0, y0, rate, 0.0)

    @cached_property
    def _system(self) -> tuple[System, Around, Method]:
        """What stays the same from call to call (`flockana.kernels.advance`)."""
        frame, (n, m), met = self.frame, self.frame.shape, self.encounters
        view = (frame.t0, frame.origin[:m].copy(), frame.drift[:m].copy())
        own, reach = np.arange(n, dtype=np.uint64), (self.form.reach, SKIN * self.form.reach)
        room = np.empty((2, m)), np.empty((2, BLOCK), np.uint64), np.empty((3, BLOCK))
        numbers = self.form.numbers
        system = System(*self.form.functions, numbers, view, self.form.moving, reach, own, *room)
        shell = float(met.shell), float(met.skirt)
        around = Around(thawed(met.radii), float(met.far), met.bodies is not None, shell, thawed(met.poles))
        given: list[Any] = [thawed(each) if isinstance(each, np.ndarray) else each for each in self.method]
        control, balance = self.allowed
        floor = tuple(float(x) for x in control.floor)
        given += [float(control.rtol), floor, float(control.longest), tuple(float(x) for x in balance)]
        return system, around, Method(*given)

    def run(self, now: Point, stops: FloatArray, due: FloatArray, ledger: FloatArray) -> tuple[Any, ...]:
        """Some steps from here."""
        most = int(np.clip(_NUMBERS // (3 * self.frame.size), 1, _STEPS))
        kept = Kept(float(now.t), now.y, now.f, float(now.h), ledger)
        result: tuple[Any, ...] = advance(*self._system, kept, stops, due, most)
        return result

    def fits(self, q: FloatArray, p: FloatArray) -> bool:
        """Whether a list has room for the pairs within reach, and the energy is finite, so it has a rate."""
        few = np.empty(1, np.uint32)
        if list_pairs(q, (1.0 + SKIN) * self.form.reach, few, few)[2] < 0:
            return False
        return bool(np.isfinite(self.law.hamiltonian(self.frame.t0, q, p)))


def engine_of(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t0: float,
    method: str,
    control: Control = EXACT,
) -> Engine | None:
    """The law and the method, compiled; None where one has no such form, or pairs are too many (RK4: no tolerances)."""
    form = law.compiled(q0.shape[1]) if method in METHODS else None
    encounters = Encounters.of(law, len(q0))
    if form is None:
        return None
    bodies = 0 if encounters.bodies is None else len(encounters.bodies.kinds)
    if sum(term.guard is not None for term in form.terms) != bodies:
        return None  # obstacles that no term, or more than one, keeps from being leapt over
    balance = (BALANCED * control.rtol, BALANCED * control.floor.work) if method in ONE_STEP else (0.0, 0.0)
    frame = Frame.of(t0, q0, p0, energetic=True)
    engine = Engine(law, form, frame, tableau(method), encounters, StepTolerances(control, balance))
    return engine if engine.fits(q0, p0) else None


def stepped(
    engine: Engine,
    q0: FloatArray,
    p0: FloatArray,
    stops: FloatArray,
    due: FloatArray,
    wanted: FloatArray | None,
    tally: Tally,
    reason: Callable[[int, float], str],
) -> Iterator[Sample | Samples]:
    """Steps to the last of the stops, and samples at the times that are due, some at a time.

    A step, and the start, is wanted if its time is among those given, which rise; None: every step is. `reason` says in
    words why a run ended early, of its status and time.
    """
    first, now = engine.start(q0, p0)
    ledger = np.array([np.nan, 0.0, 0.0, 0.0])
    tally.evaluations, tally.notes["redone"] = tally.evaluations + 1, 0
    if wanted is None or _among(np.array([first.t]), wanted)[0]:
        yield first
    stops, due = stops[stops > first.t], due[due > first.t]
    while stops.size:
        status, t, y, f, h, evaluations, redone, passed, sampled, steps, between = engine.run(now, stops, due, ledger)
        tally.evaluations, tally.notes["redone"] = tally.evaluations + evaluations, tally.notes["redone"] + redone
        made, states, work = steps
        tally.steps += made.size
        if wanted is not None:
            yield from _parted(wanted, due[:sampled], between, steps)
        elif made.size:
            yield Samples(made, states[:, 0], states[:, 1], states[:, 2], {"work": work})
        if status == CROWDED:
            tally.fail(f"more pairs within reach at t = {t:g} than a list has room for: try method='{_UNLISTED}'")
        elif status == SINGULAR:
            tally.fail(at_a_pole(t))
        elif status != RUNNING:
            tally.fail(reason(status, t + h))
        if status != RUNNING:
            return
        now, stops, due = Point(t, y, f, h), stops[passed:], due[sampled:]


def _parted(wanted: FloatArray, due: FloatArray, between: Any, steps: Any) -> Iterator[Samples]:
    """The steps that are no samples, then the samples; one by one they would cost as much as the steps of small flocks.

    Steps come first: a run that is interrupted after them has no samples whose steps are not known.
    """
    (made, states, work), (seen, done) = steps, between
    chosen, apart = _among(made, wanted), ~_among(due, made)  # where a step ended there is nothing in what is between
    if not chosen.all():
        t, other = (made[~chosen], states[~chosen]) if chosen.any() else (made, states)
        yield Samples(t, other[:, 0], other[:, 1], other[:, 2], {}, wanted=False)
    if chosen.any() or apart.any():
        t = np.concatenate([made[chosen], due[apart]])
        order = np.argsort(t)
        some, its_work = (
            np.concatenate([own[chosen], others[apart]])[order] for own, others in ((states, seen), (work, done))
        )
        yield Samples(t[order], some[:, 0], some[:, 1], some[:, 2], {"work": its_work})


def _among(times: FloatArray, some: FloatArray) -> npt.NDArray[np.bool_]:
    """Which times are among some others, which rise: `np.isin` would sort them again for each block of steps.

    Examples
    --------
    >>> _among(np.array([0.0, 1.0, 3.0]), np.array([1.0, 2.0])).tolist()
    [False, True, False]
    """
    nearest = np.append(some, np.nan)[np.searchsorted(some, times)]
    return np.asarray(nearest == times)
