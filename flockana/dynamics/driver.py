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

_MANY, _SHORT = 10_000, 1e-5  # so many steps that are on average shorter than this share of the law's time end a run
_ENDLESS = 1e9  # and so do steps of which so many more would be needed: hours of the fastest flocks


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
    checks, (since, before) = StepChecks(law, stepper.frame, stepper.plan), (start.t, 0)
    tally.notes["redone"] = 0
    if keep is None or keep[0] == start.t:  # not a rounding beside it, as in the frame
        yield start.sample
    while stepper.stops.size:
        good = stepper.advance(checks)
        tally.evaluations, tally.notes["redone"] = stepper.evaluations, stepper.redone
        if good:
            tally.steps += good
            yield from _parted(stepper, good, keep)
        failure, at = stepper.failure, float(stepper.block.t[good])
        if stepper.plan.solver.dt:
            passed = len(stepper.plan.stops) - int((stepper.stops > at).sum())
            failure = failure or stepper.plan.describe_cuts(tally.steps, passed)
        elif tally.steps >= before + _MANY:
            failure = failure or _describe_short_steps(stepper, law, good, (at - since) / (tally.steps - before))
            since, before = at, tally.steps
        if failure:
            tally.fail(failure.rstrip(".") + _nearest_pair(stepper, good) if 0.0 in law.poles else failure)
            return
        stepper.continue_from(good)


def _describe_short_steps(stepper: Stepper, law: Law, good: int, mean: float) -> str:
    """Return in words that the last steps are far too short for the law's own time or the span, '' if they are not."""
    at, end = float(stepper.block.t[good]), float(stepper.stops[-1]) if stepper.stops.size else -np.inf
    if end - at > _ENDLESS * mean:
        return (
            f"it would take {(end - at) / mean:.1e} more steps to t = {end:g}: the last {_MANY} are {mean:.2g} long on "
            "average; expected a shorter span or slower gains"
        )
    if law.scales is None or mean >= _SHORT * law.scales.time:
        return ""
    text = f"steps collapse at t = {at:g}: the last {_MANY} are {mean:.2g} long on average"
    return text if 0.0 in law.poles else text + _nearest_pair(stepper, good)


def _nearest_pair(stepper: Stepper, row: int) -> str:
    """Return in words which agents are nearest at a row of the block; '' for one agent."""
    from scipy.spatial import cKDTree

    (n, m), order = stepper.frame.shape, stepper.order
    if n == 1:
        return ""
    q = stepper.block.y[row, : n * m].reshape(n, m)  # as the frame sees it: finer than the positions
    apart, others = map(np.asarray, cKDTree(q).query(q, k=2))
    k = int(apart[:, 1].argmin())
    i, j = sorted((int(order[k]), int(order[others[k, 1]])))
    return f"; the nearest agents, {i} and {j}, are {apart[k, 1]:.3g} apart"


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
