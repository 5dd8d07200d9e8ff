"""What the two forms of the dead-zone theorem share: its law, its hypotheses, its distances and its limits."""

from __future__ import annotations

from dataclasses import replace
from math import inf, log
from typing import Any

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.interactions.dead_zone import DeadZoneInteraction
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.semi_implicit import SemiImplicitEuler
from flockana.measures.metrics import min_distance
from flockana.theorems.dead_zone.parting import Parts, parts
from flockana.theorems.limits import Certificate, limit_claim
from flockana.theorems.rounding import EPS
from flockana.theorems.theorem import Claim, Hypothesis, judge

PROOF = "dead-zone"
_BOUND = 1e-9  # relative rounding of the explicit bound: that of H̄(0)/2k_r in an exponent


def dead_zone_law(run: Trajectory) -> DeadZoneFlocking | None:
    """The dead-zone law of a run, of its semi-implicit Euler steps too; None under another law, a subclass included."""
    law: Any = run.law.law if type(run.law) is SemiImplicitEuler else run.law
    exact = type(law) is DeadZoneFlocking and type(law.interaction) is DeadZoneInteraction
    return law if exact else None


def hypotheses(run: Trajectory) -> list[Hypothesis]:
    """The law, and distinct positions at the start."""
    law = dead_zone_law(run)
    applies = Hypothesis("the dead-zone law is applied", "met" if law else "unmet", detail=type(run.law).__name__)
    least = min_distance(run.q[0])
    distinct = Hypothesis("agents start at distinct places", "met" if least > 0.0 else "unmet", least)
    return [applies, distinct]


def at_the_end(run: Trajectory, law: DeadZoneFlocking) -> Parts:
    """The parts of the flock in the last state of a run, and what is certain of them; kept with the run."""
    dt = run.law.dt if isinstance(run.law, DiscreteLaw) else None
    return run.remembered("dead-zone parts", lambda: parts(run.q[-1], run.p[-1], law, dt))


def settling(end: Parts) -> Certificate:
    """Velocities match within each part for ever: each settles by itself, and no two of them meet."""
    return min((*(part.settles for part in end.parts), end.apart), key=lambda certificate: certificate.margin)


def one_velocity(run: Trajectory, end: Parts, needs: list[Hypothesis], *, name: str) -> Claim:
    """K̃ → 0: certain of one part that settles, refuted where parts are certain to part, each at its own velocity."""
    series = run.metric("velocity_mismatch")
    claim = limit_claim(
        name,
        needs,
        [settling(end) if end.count == 1 else Certificate(-1.0, end.apart.text)],
        computed=float(series[-1]),
        stated="K̃ -> 0: all velocities match",
        witness={"time": float(run.t[-1]), "K̃ at the start": float(series[0])},
        detail=f"K̃ goes from {series[0]:.3g} to {series[-1]:.3g} at t = {run.t[-1]:g}",
    )
    if not end.parting:
        return claim
    margin, error = end.separation.margin, end.separation.error
    status, detail = judge(-margin, error, needs), f"{claim.detail}: {end.count} parts keep their own for ever"
    return replace(claim, status=status, margin=-margin, error=error, proof=PROOF, detail=detail)


def no_collision(run: Trajectory, bound: float, unit: float, needs: list[Hypothesis], *, name: str) -> Claim:
    """No two agents come closer than a bound: between the samples too, except for a map, which has nothing there.

    The margin is ln(ρ/bound), as a bound may be exponentially small; ρ over the unit where the bound is 0.
    """
    if isinstance(run.law, DiscreteLaw) or len(run.t) == 1:
        series = run.metric("min_distance")
        k = int(np.argmin(series))
        least, upper, where, time = float(series[k]), float(series[k]), "at the samples", float(run.t[k])
    else:
        closest = run.closest_approach()
        least, upper, where, time = closest.lower, closest.distance, "ever", closest.time
    rounding = 4.0 * EPS * float(np.abs(run.q).max())
    margin, error = _above(least, bound, unit, rounding)
    status = judge(margin, error, needs)
    if status == "refuted" and upper > bound:  # the lower bound is weak where samples are sparse
        status = "inconclusive"
    return Claim(
        name,
        status,
        computed=least,
        stated=f"every distance > {bound:.4g}",
        margin=margin,
        error=error,
        witness={"time": time},
        proof=PROOF,
        detail=f"no two agents come closer than {least:.4g} {where}; the bound is {bound:.3g}",
    )


def _above(least: float, bound: float, unit: float, rounding: float) -> tuple[float, float]:
    """(margin, error) of a distance against a bound; one agent has none."""
    if least == inf:
        return 1.0, EPS
    if bound == 0.0:
        return least / unit, rounding / unit + EPS
    if least <= rounding:
        return float("nan"), inf
    return log(least / bound), 4.0 * rounding / least + _BOUND
