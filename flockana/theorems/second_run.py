"""What a verdict about a run must not hang on: how finely it was integrated, how it ended, whether it is the law's.

A run is one numerical solution. Before it is judged its samples are held against its law; after it was judged the same
start is integrated once more, a hundred times more tightly, and judged again. What the two disagree about is the
integrator's, not the law's: by so much is a claim's error larger, and a claim that both do not make is not made.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError, FlockanaError
from flockana.dynamics.simulate import simulate
from flockana.dynamics.tolerance import FINEST
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.switched import SwitchedLaw
from flockana.theorems.theorem import Claim, judge

TIGHTER = 1e-2  # the second run's tolerances over the first's
DOUBT = 2.0  # times what two runs differ by: all of the first's error, if the second's is at most half as large
RK4_SECOND = 1e-10  # relative tolerance of the second run of one with a fixed step
SAME_INPUT = 1e-8  # of the largest input: other machine code evaluates a law to 1e-13, another law does not
INTERVALS = 6  # that look edited by some sign, and evenly spread ones, which are integrated again
SLACK = 100.0  # how often the error of integrating an interval, as two tolerances show it, a sample may be off,
FLOOR = 300.0  # and how often the relative tolerance, where the two agree by chance or to rounding
_LOW_ORDER = ("RK23", "RK45")  # methods that take many times the steps of DOP853 to a tight tolerance

Judge = Callable[[Trajectory], Iterable[Claim]]


def corroborated(claims: Sequence[Claim], run: Trajectory, judge_again: Judge) -> tuple[Claim, ...]:
    """The claims as the run and a tighter second run of the same start make them.

    Claims of a rigour above numeric, and those that are vacuous or inconclusive already, stay as they are. A failed
    run decides nothing. A map has no second run: it is exact but for rounding.
    """
    if not any(_open(claim) for claim in claims):
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
    return tuple(_agreed(one, two) for one, two in zip(claims, judge_again(again), strict=True))


def _open(claim: Claim) -> bool:
    return claim.rigour == "numeric" and claim.status in ("verified", "refuted")


def _undecided(claim: Claim, reason: str) -> Claim:
    return replace(claim, status="inconclusive", detail=f"{claim.detail}; {reason}".lstrip("; "))


def _all_undecided(claims: Sequence[Claim], reason: str) -> tuple[Claim, ...]:
    return tuple(_undecided(claim, reason) if _open(claim) else claim for claim in claims)


def _agreed(one: Claim, two: Claim) -> Claim:
    """A claim with the second run's difference in its error; inconclusive unless both decide it alike beyond that."""
    if not _open(one):
        return one
    if one.status != two.status:
        return _undecided(one, f"a tighter second run reads {two.status}")
    if one.margin is None or two.margin is None or one.margin == two.margin:
        return one
    off = abs(one.margin - two.margin)
    error = (one.error or 0.0) + (DOUBT * off if np.isfinite(off) else np.inf)
    if judge(abs(one.margin), error, []) != "verified":
        return _undecided(replace(one, error=error), f"a tighter second run differs by {off:.2g}")
    return replace(one, error=error)


def second_run(run: Trajectory) -> Trajectory:
    """The same law from the same start, a hundred times more tightly, at the same times; kept with the run."""
    return run.remembered("second run", lambda: _integrated(run, 0, len(run.t), TIGHTER))


def _integrated(run: Trajectory, first: int, stop: int, factor: float, *, own_step: bool = False) -> Trajectory:
    """The law from sample `first` through the times of the samples before `stop`, by the run's method if it adapts."""
    stats, span = run.stats, (float(run.t[first]), float(run.t[stop - 1]))
    how: dict[str, Any] = {"method": "DOP853", "rtol": RK4_SECOND}
    if "rtol" in stats:
        method = stats.get("method", "DOP853")
        how = {"method": "DOP853" if method in _LOW_ORDER else method, "rtol": max(factor * stats["rtol"], FINEST)}
        how["atol"] = None if stats.get("atol") is None else factor * stats["atol"]
    elif own_step and "dt" in stats:
        how = {"method": "RK4", "dt": stats["dt"]}
    return simulate(run.law, run.q[first], run.p[first], span, t_eval=run.t[first:stop], **how)


def ensure_fits(run: Trajectory) -> None:
    """Raise unless the samples of a run are those of its law: the inputs, and some steps, are computed anew."""
    run.remembered("fits", lambda: _ensure_fits(run))


def _ensure_fits(run: Trajectory) -> bool:
    if isinstance(run.law, DiscreteLaw):
        _ensure_steps_of_map(run)
        return True
    off = np.abs(run.u - run._flows[0]).max(axis=(1, 2))
    if isinstance(run.law, SwitchedLaw):
        off[_at_switches(run.law, run)] = 0.0
    k = int(np.argmax(off))
    if not off[k] <= SAME_INPUT * max(float(np.abs(run.u).max()), run.scales.force):
        raise ArgumentError(
            f"u at t = {run.t[k]:g} is off by {off[k]:.3g} from the input of {type(run.law).__name__} at that state: "
            "expected a run as simulate returned it; was it edited, or is it of another law?"
        )
    for k in _intervals(run):
        _ensure_leads_on(run, k)
    return True


def _at_switches(law: SwitchedLaw, run: Trajectory) -> list[bool]:
    """Samples where a pair is at the edge of its piece: there the input has two values."""
    tiny = 1e-9 * run.scales.length
    return [bool((law.margins(law.pieces(q), q).inside < tiny).any()) for q in run.q]


def _intervals(run: Trajectory) -> list[int]:
    """Some intervals between samples: evenly spread ones, and those whose ends fit a smooth path least."""
    count = len(run.t) - 1
    if count == 0:
        return []
    h = np.diff(run.t)[:, None, None]
    (q0, q1), (p0, p1), (u0, u1) = ((x[:-1], x[1:]) for x in (run.q, run.p, run.u))
    bend = np.abs(q1 - q0 - h * (p0 + p1) / 2.0 + h * h * (u1 - u0) / 12.0).max(axis=(1, 2))
    kick = np.abs(p1 - p0 - h * (u0 + u1) / 2.0).max(axis=(1, 2))
    signs = [bend, kick]
    if "work" in run.extra:
        signs.append(np.abs(np.diff(run.energy_residual)))
    if run.status != "failed" and len((again := second_run(run)).t) == len(run.t):
        apart = [(getattr(run, name) - getattr(again, name)) for name in "qp"]  # grows smoothly, unless by an edit
        signs += [np.abs(np.diff(series, axis=0)).max(axis=(1, 2)) for series in apart]
    worst = [k for series in signs for k in np.argsort(series)[-INTERVALS:]]
    return sorted({int(k) for k in (*worst, *np.linspace(0, count - 1, INTERVALS))})


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
        found, again, tight = (getattr(each, name)[at] for each, at in ((run, k + 1), (near, 1), (exact, 1)))
        allowed = SLACK * float(np.abs(again - tight).max()) + FLOOR * run.stats.get("rtol", FINEST) * unit
        off = float(np.minimum(np.abs(found - again).max(), np.abs(found - tight).max()))
        if not off <= allowed:
            raise ArgumentError(
                f"{name} at t = {run.t[k + 1]:g} is off by {off:.3g} from where {type(run.law).__name__} leads from "
                f"the sample at t = {run.t[k]:g} (to {allowed:.2g}): expected a run as simulate returned it; was it "
                "edited, or is it of another law?"
            )


def _ensure_steps_of_map(run: Trajectory) -> None:
    """Raise unless some steps of the map, made anew, lead to the samples; a run thinned out is not looked at."""
    law: DiscreteLaw = run.law
    at = np.flatnonzero(np.abs(np.diff(run.t) - law.dt) <= 1e-6 * law.dt)
    chosen = at[np.linspace(0, at.size - 1, min(at.size, 2 * INTERVALS)).astype(int)] if at.size else at
    for k in chosen.tolist():
        memory = {name: series[k].copy() for name, series in run.extra.items()}
        q, p, _, _ = law.step(float(run.t[k]), run.q[k], run.p[k], memory)
        for name, found, value in (("q", run.q[k + 1], q), ("p", run.p[k + 1], p)):
            unit = run.scales.length if name == "q" else run.scales.speed
            if not _close(found, value, unit + float(np.abs(value).max())):
                raise ArgumentError(
                    f"{name} at t = {run.t[k + 1]:g} is not where a step of {type(law).__name__} leads from "
                    f"t = {run.t[k]:g}: expected a run as simulate returned it; was it edited, or is it of another law?"
                )


def _close(found: FloatArray, value: FloatArray, unit: float) -> bool:
    return bool(np.abs(found - value).max() <= SAME_INPUT * unit)
