"""Consistency of a run's samples with its law, checked before a theorem is judged."""

from __future__ import annotations

import numpy as np

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.dynamics.tolerance import FINEST
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.switched import SwitchedLaw
from flockana.theorems.map_steps import ensure_steps_of_map
from flockana.theorems.second_runs import TIGHTER, integrated

SAME_INPUT = 1e-8  # of the largest input: other machine code evaluates a law to 1e-13, another law does not
INTERVALS = 6  # evenly spread ones are integrated again: enough to show a law that is another function each time
SLACK = 100.0  # how often the error of integrating an interval, as two tolerances show it, a sample may be off,
FLOOR = 300.0  # and how often the relative tolerance, where the two agree by chance or to rounding


def ensure_fits(run: Trajectory) -> None:
    """Raise unless recomputed inputs and some recomputed steps agree with the run's samples."""
    run.cached("fits", lambda: _ensure_fits(run))


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
    for k in sorted({*np.linspace(0, len(run.t) - 2, INTERVALS).astype(int).tolist()} if len(run.t) > 1 else ()):
        _ensure_leads_on(run, k)
    return True


def _rounded_input(run: Trajectory, k: int) -> float:
    """Return the part of a force that rounding of a sample explains."""
    if run.law.compiled(run.m) is None:
        return 0.0
    try:
        slopes = run.law.derivatives(run.t[k], run.q[k], run.p[k])
    except FlockanaError:  # where the law has none no run comes
        return 0.0
    forces = zip(slopes, (run.q[k], run.p[k]), strict=True)
    return float(sum(abs(slope) @ np.spacing(np.abs(x).ravel()) for slope, x in forces).max())


def _at_switches(law: SwitchedLaw, run: Trajectory) -> list[bool]:
    """Return the samples at which a pair is at a jump of the force, where the input has two values."""
    tiny = 1e-9 * run.scales.length
    return [bool((law.margins(law.pieces(q), q).inside < tiny).any()) for q in run.q]


def _ensure_leads_on(run: Trajectory, k: int) -> None:
    """Raise unless the law, integrated from sample k as the run was, leads to sample k + 1."""
    if run.status == "failed" and k == len(run.t) - 2:
        return
    try:
        near, exact = (
            integrated(run, k, run.t[k : k + 2], factor, own_step=factor == 1.0) for factor in (1.0, TIGHTER)
        )
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
