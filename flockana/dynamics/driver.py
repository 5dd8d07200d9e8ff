"""Driver of all runs of continuous laws: steps that pass all checks, and samples between them.

Steppers are compiled with the law (`flockana.dynamics.compiled`) or interpreted
(`flockana.dynamics.interpreted`). Beside the state, ∫ dH/dt is integrated as one more variable.
"""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.dynamics.compiled import engine_of
from flockana.dynamics.encounters import StepChecks
from flockana.dynamics.frame import Frame, Plan
from flockana.dynamics.interpreted import Interpreter
from flockana.dynamics.sample import Sample, Samples, Start, Tally
from flockana.dynamics.stepper import Stepper
from flockana.dynamics.switches import Switches, switched
from flockana.laws.law import Law
from flockana.laws.switched import SwitchedLaw


def integrated(law: Law, start: Start, plan: Plan, keep: FloatArray | None, tally: Tally) -> Iterator[Sample | Samples]:
    """Yield samples and steps of a run as they are made; `keep` lists the sample times, None keeps every step."""
    # A step that leaps over an encounter or a pole, or breaks the energy's balance, is made again, and shorter. A law
    # with jumps is integrated from switch to switch, except by RK4; one that slides ends the run. `tally.notes` gets
    # the numbers of steps made again and of switches.
    jumps = isinstance(law, SwitchedLaw) and law.located and plan.solver.dt is None
    engine = None if jumps else engine_of(law, start, plan)
    if engine is not None:
        yield from _driven(engine, law, start, keep, tally)
        return
    frame = Frame.of(start.t, start.q, start.p, energetic=start.energetic)
    switches = Switches(law, start.q) if jumps else None  # type: ignore[arg-type]
    solver = Interpreter(law, frame, plan, frame.start(start.q, start.p), None if switches is None else switches.flow)
    if switches is None:
        yield from _driven(solver, law, start, keep, tally)
    else:
        yield from switched(solver, switches, start, keep, tally)


def _driven(
    stepper: Stepper, law: Law, start: Start, keep: FloatArray | None, tally: Tally
) -> Iterator[Sample | Samples]:
    """Yield steps up to the last stop, and samples at the times that are due."""
    checks = StepChecks(law, stepper.frame, stepper.plan)
    tally.notes["redone"] = 0
    if keep is None or keep[0] == start.t:  # not a rounding beside it, as in the frame
        yield start.sample
    while stepper.stops.size:
        good = stepper.advance(checks)
        tally.evaluations, tally.notes["redone"] = stepper.evaluations, stepper.redone
        if good:
            tally.steps += good
            yield from _parted(stepper, good, keep)
        if stepper.failure:
            tally.fail(stepper.failure)
            return
        stepper.continue_from(good)


def _parted(stepper: Stepper, good: int, wanted: FloatArray | None) -> Iterator[Samples]:
    """Yield the steps that are not samples, then the samples, in blocks for speed."""
    # Steps come first: a run that is interrupted after them has no samples whose steps are not known.
    made, (states, work) = stepper.block.t[1 : good + 1].copy(), stepper.states(good)

    def samples(t: FloatArray, states: FloatArray, work: FloatArray, wanted: bool = True) -> Samples:
        extra = {"work": work} if wanted and stepper.frame.energetic else {}
        return Samples(t, states[:, 0], states[:, 1], states[:, 2], extra, wanted)

    if wanted is None:
        yield samples(made, states, work)
        return
    due, seen, done = stepper.between()
    chosen, apart = _among(made, wanted), ~_among(due, made)  # where a step ended there is nothing in what is between
    if not chosen.all():
        own = np.flatnonzero(~chosen)
        rows = slice(own[0], own[-1] + 1) if own[-1] - own[0] < own.size else own  # a view where they are contiguous
        yield samples(made[rows], states[rows], work, wanted=False)
    if chosen.any() or apart.any():
        t = np.concatenate([made[chosen], due[apart]])
        order = np.argsort(t)
        some, its_work = (
            np.concatenate([own[chosen], others[apart]])[order] for own, others in ((states, seen), (work, done))
        )
        yield samples(t[order], some, its_work)


def _among(times: FloatArray, some: FloatArray) -> npt.NDArray[np.bool_]:
    """Return which times occur in a rising list, without `np.isin`, which would sort the list for each block."""
    nearest = np.append(some, np.nan)[np.searchsorted(some, times)]
    return np.asarray(nearest == times)
