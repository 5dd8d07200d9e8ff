"""The dead-zone law of a run, and hypotheses and claims that both forms of the dead-zone theorem have."""

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
from flockana.theorems.claims import judged
from flockana.theorems.dead_zone.parting import Components, components_of
from flockana.theorems.hypotheses import condition
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
    least = min_distance(run.q[0])
    return [
        condition("the dead-zone law is applied", law is not None, detail=type(run.law).__name__),
        condition("agents start at distinct places", least > 0.0, least),
    ]


def final_components(run: Trajectory, law: DeadZoneFlocking) -> Components:
    """The components of the net in the last state of a run, and what is certain of them; kept with the run."""
    dt = run.law.dt if isinstance(run.law, DiscreteLaw) else None
    return run.remembered("dead-zone components", lambda: components_of(run.q[-1], run.p[-1], law, dt))


def settling(end: Components) -> Certificate:
    """Certificate that velocities match within each component: each settles by itself, and no two of them meet."""
    return min((*(c.settles for c in end.members), end.apart), key=lambda certificate: certificate.margin)


def velocities_match(run: Trajectory, end: Components, needs: list[Hypothesis], *, name: str) -> Claim:
    """K̃ → 0: certain of one component that settles, refuted where components part, each at its own velocity."""
    series = run.metric("normalised_velocity_mismatch")
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
    margin, error = -end.separation.margin, end.separation.error
    detail = f"{claim.detail}: {end.count} parts keep their own for ever"
    return replace(claim, status=judge(margin, error, needs), margin=margin, error=error, proof=PROOF, detail=detail)


def no_collision(run: Trajectory, bound: float, unit: float, needs: list[Hypothesis], *, name: str) -> Claim:
    """No two agents come closer than a bound: between the samples too, except for a map, which has nothing there.

    The margin is ln(ρ/bound), as a bound may be exponentially small; ρ over the unit where the bound is 0.
    """
    if isinstance(run.law, DiscreteLaw) or len(run.t) == 1:
        series = run.metric("min_distance")
        k = int(np.argmin(series))
        lower, upper, where, time = float(series[k]), float(series[k]), "at the samples", float(run.t[k])
    else:
        closest = run.closest_approach()
        lower, upper, where, time = closest.lower, closest.distance, "ever", closest.time
    rounding = 4.0 * EPS * float(np.abs(run.q).max())
    return judged(
        name,
        *_log_ratio(lower, bound, unit, rounding),
        needs,
        refutes=not upper > bound,  # the lower bound is weak where samples are sparse
        computed=lower,
        stated=f"every distance > {bound:.4g}",
        witness={"time": time},
        proof=PROOF,
        detail=f"no two agents come closer than {lower:.4g} {where}; the bound is {bound:.3g}",
    )


def _log_ratio(least: float, bound: float, unit: float, rounding: float) -> tuple[float, float]:
    """Logarithm of a distance over a bound, and its error; a single agent has no distances."""
    if least == inf:
        return 1.0, EPS
    if bound == 0.0:
        return least / unit, rounding / unit + EPS
    if least <= rounding:
        return float("nan"), inf
    return log(least / bound), 4.0 * rounding / least + _BOUND
