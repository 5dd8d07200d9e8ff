"""Checks of a run before and after a theorem is judged on it: that it solves its law, and that a finer run agrees.

A run is one numerical solution. Before it is judged its samples are compared with its law; afterwards the same start is
integrated once more, a hundred times more tightly, and judged again. By what the margins of the two differ a claim's
error grows, and a claim that only one of the two decides is inconclusive.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.base.seals import is_sealed
from flockana.dynamics.simulate import simulate
from flockana.dynamics.tolerance import FINEST
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.switched import SwitchedLaw
from flockana.theorems.map_steps import ensure_steps_of_map
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

TIGHTER = 1e-2  # the second run's tolerances over the first's
DOUBT = 2.0  # times what two runs differ by: all of the first's error, if the second's is at most half as large
RK4_SECOND = 1e-10  # relative tolerance of the second run of one with a fixed step
SAME_INPUT = 1e-8  # of the largest input: other machine code evaluates a law to 1e-13, another law does not
INTERVALS = 6  # by each indicator of an edit, and as many evenly spread ones, are integrated again
SLACK = 100.0  # how often the error of integrating an interval, as two tolerances show it, a sample may be off,
FLOOR = 300.0  # and how often the relative tolerance, where the two agree by chance or to rounding
_LOW_ORDER = ("RK23", "RK45")  # methods that take many times the steps of DOP853 to a tight tolerance

Judge = Callable[[Trajectory], Iterable[Claim]]


def examined_twice(
    theorem: Theorem, run: Trajectory, tolerances: Tolerances
) -> tuple[tuple[Hypothesis, ...], tuple[Claim, ...]]:
    """Hypotheses and claims of a theorem on a run, the claims corroborated by a tighter second run."""
    hypotheses, claims = theorem.examine(run, tolerances)
    return hypotheses, corroborated(claims, run, lambda again: theorem.examine(again, tolerances)[1])


def corroborated(claims: Sequence[Claim], run: Trajectory, judge_again: Judge) -> tuple[Claim, ...]:
    """The claims that a run and a tighter second run of the same start support alike; the others become inconclusive.

    Claims of a rigour above numeric, and those that are vacuous or inconclusive already, stay as they are. A failed
    run decides nothing. A map has no second run: it is exact but for rounding.
    """
    if not any(_decided(claim) for claim in claims):
        return tuple(claims)
    if run.status == "failed":
        return _all_undecided(claims, f"the run failed: {run.message}")
    if len(run.t) == 1:
        return _all_undecided(claims, "one sample shows no motion")
    if isinstance(run.law, DiscreteLaw):
        return tuple(claims)
    again = second_run(run)
    if again.status != "complete" or len(again.t) != len(run.t):
        return _all_undecided(claims, f"a tighter second run ended at t = {again.t[-1]:.6g}: {again.message}")
    return tuple(_agreed(*pair) for pair in zip(claims, judge_again(again), strict=True))


def _decided(claim: Claim) -> bool:
    """Whether a numerical computation decided it."""
    return claim.rigour == "numeric" and claim.status in ("verified", "refuted")


def _undecided(claim: Claim, reason: str) -> Claim:
    return replace(claim, status="inconclusive", detail=f"{claim.detail}; {reason}".lstrip("; "))


def _all_undecided(claims: Sequence[Claim], reason: str) -> tuple[Claim, ...]:
    return tuple(_undecided(claim, reason) if _decided(claim) else claim for claim in claims)


def _agreed(first: Claim, second: Claim) -> Claim:
    """A claim with the second run's difference in its error; inconclusive unless both decide it alike beyond that."""
    if not _decided(first):
        return first
    if first.status != second.status:
        return _undecided(first, f"a tighter second run reads {second.status}")
    if first.margin is None or second.margin is None or first.margin == second.margin:
        return first
    difference = abs(first.margin - second.margin)
    error = (first.error or 0.0) + (DOUBT * difference if np.isfinite(difference) else np.inf)
    if judge(abs(first.margin), error, []) != "verified":
        return _undecided(replace(first, error=error), f"a tighter second run differs by {difference:.2g}")
    return replace(first, error=error)


def second_run(run: Trajectory) -> Trajectory:
    """The same law from the same start, a hundred times more tightly, at the same times; kept with the run."""
    return run.remembered("second run", lambda: _integrated(run, 0, len(run.t), TIGHTER))


def _integrated(run: Trajectory, first: int, stop: int, factor: float, *, own_step: bool = False) -> Trajectory:
    """The law from sample `first` through the times of the samples before `stop`, by the run's method if it adapts."""
    stats, span = run.stats, (float(run.t[first]), float(run.t[stop - 1]))
    options: dict[str, Any] = {"method": "DOP853", "rtol": RK4_SECOND}
    if "rtol" in stats:
        method = stats.get("method", "DOP853")
        options = {"method": "DOP853" if method in _LOW_ORDER else method, "rtol": max(factor * stats["rtol"], FINEST)}
        options["atol"] = None if stats.get("atol") is None else factor * stats["atol"]
    elif own_step and "dt" in stats:
        options = {"method": "RK4", "dt": stats["dt"]}
    return simulate(run.law, run.q[first], run.p[first], span, t_eval=run.t[first:stop], **options)


def ensure_fits(run: Trajectory) -> None:
    """Raise unless the samples of a run are those of its law: the inputs, and some steps, are computed anew."""
    run.remembered("fits", lambda: _ensure_fits(run))


def _ensure_fits(run: Trajectory) -> bool:
    if isinstance(run.law, DiscreteLaw):
        ensure_steps_of_map(run)
        return True
    difference = np.abs(run.u - run._flows[0]).max(axis=(1, 2))
    if isinstance(run.law, SwitchedLaw):
        difference[_at_switches(run.law, run)] = 0.0
    allowed = SAME_INPUT * max(float(np.abs(run.u).max()), run.scales.force)
    for k in np.flatnonzero(~(difference <= allowed)).tolist():
        if difference[k] <= allowed + _rounded_input(run, k):
            continue
        raise ArgumentError(
            f"u at t = {run.t[k]:g} is off by {difference[k]:.3g} from the input of {type(run.law).__name__} at that "
            "state: expected a run as simulate returned it; was it edited, or is it of another law?"
        )
    for k in _suspicious_intervals(run):
        _ensure_leads_on(run, k)
    return True


def _rounded_input(run: Trajectory, k: int) -> float:
    """How much of a force comes from the rounding of a sample: compiled runs compute it in a frame of their own."""
    if run.law.compiled(run.m) is None:
        return 0.0
    try:
        slopes = run.law.derivatives(run.t[k], run.q[k], run.p[k])
    except FlockanaError:  # where the law has none no run comes
        return 0.0
    forces = zip(slopes, (run.q[k], run.p[k]), strict=True)
    return float(sum(abs(slope) @ np.spacing(np.abs(x).ravel()) for slope, x in forces).max())


def _at_switches(law: SwitchedLaw, run: Trajectory) -> list[bool]:
    """Samples at which the distance of a pair is one where the force jumps: there the input has two values."""
    tiny = 1e-9 * run.scales.length
    return [bool((law.margins(law.pieces(q), q).inside < tiny).any()) for q in run.q]


def _suspicious_intervals(run: Trajectory) -> list[int]:
    """Intervals to integrate again: evenly spread ones, and those whose ends lie farthest from a smooth path.

    A run that carries the seal of `simulate` was not edited: of it the evenly spread ones are enough to
    show a law that is plainly another function each time.
    """
    count = len(run.t) - 1
    if count == 0:
        return []
    spread = np.linspace(0, count - 1, INTERVALS)
    if is_sealed(run):
        return sorted({int(k) for k in spread})
    h = np.diff(run.t)[:, None, None]
    (q0, q1), (p0, p1), (u0, u1) = ((x[:-1], x[1:]) for x in (run.q, run.p, run.u))
    jump_of_q = np.abs(q1 - q0 - h * (p0 + p1) / 2.0 + h * h * (u1 - u0) / 12.0).max(axis=(1, 2))
    jump_of_p = np.abs(p1 - p0 - h * (u0 + u1) / 2.0).max(axis=(1, 2))
    indicators = [jump_of_q, jump_of_p]
    if "work" in run.extra:
        indicators.append(np.abs(np.diff(run.energy_residual)))
    if run.status != "failed" and len((again := second_run(run)).t) == len(run.t):
        apart = [(getattr(run, name) - getattr(again, name)) for name in "qp"]  # grows smoothly, unless by an edit
        indicators += [np.abs(np.diff(series, axis=0)).max(axis=(1, 2)) for series in apart]
    worst = [k for series in indicators for k in np.argsort(series)[-INTERVALS:]]
    return sorted({int(k) for k in (*worst, *spread)})


def _ensure_leads_on(run: Trajectory, k: int) -> None:
    """Raise unless the law, integrated from sample k as the run was, leads to sample k + 1."""
    if run.status == "failed" and k == len(run.t) - 2:
        return
    try:
        near, exact = _integrated(run, k, k + 2, 1.0, own_step=True), _integrated(run, k, k + 2, TIGHTER)
    except FlockanaError:  # the state may be one from which no run may start
        return
    if len(near.t) < 2 or len(exact.t) < 2:
        return
    size = run.scales.length + float(np.abs(run.q[k] - run.q[k].mean(axis=0)).max())
    speed = run.scales.speed + float(np.abs(run.p[k]).max())
    for name, unit in (("q", size), ("p", speed)):
        sample, again, tight = (getattr(each, name)[at] for each, at in ((run, k + 1), (near, 1), (exact, 1)))
        allowed = SLACK * float(np.abs(again - tight).max()) + FLOOR * run.stats.get("rtol", FINEST) * unit
        difference = float(np.minimum(np.abs(sample - again).max(), np.abs(sample - tight).max()))
        if not difference <= allowed:
            raise ArgumentError(
                f"{name} at t = {run.t[k + 1]:g} is off by {difference:.3g} from where {type(run.law).__name__} leads "
                f"from the sample at t = {run.t[k]:g} (to {allowed:.2g}): expected a run as simulate returned it; was "
                "it edited, or is it of another law?"
            )
