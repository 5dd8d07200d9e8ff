"""Theorem 1 of the dead-zone paper, repaired: saturated energy, one velocity per component, an explicit distance."""

from __future__ import annotations

import numpy as np

from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.theorems.dead_zone_case import PROOF, dead_zone_law, hypotheses, no_collision, parts
from flockana.theorems.energy import balance
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory


def _rate(run: Trajectory, law: DeadZoneFlocking, needs: list[Hypothesis]) -> Claim:
    """−k₂ pᵀL̂p is a sum of squares: no rounding can change its sign."""
    rate = np.array([law.flow(float(t), q, p)[1] for t, q, p in zip(run.t, run.q, run.p, strict=True)])
    worst = int(np.argmax(rate))
    unmet = any(need.status == "unmet" for need in needs)
    return Claim(
        "rate",
        "vacuous" if unmet else "verified" if rate[worst] <= 0.0 else "refuted",
        computed=float(rate[worst]),
        stated="dH̄/dt = -k₂ pᵀL̂p <= 0, across all switches",
        margin=-float(rate[worst]),
        error=0.0,
        witness={"time": float(run.t[worst])},
        proof=PROOF,
        detail=f"the saturated energy goes from {run.energy()[0]:.6g} to {run.energy()[-1]:.6g}",
    )


def _balance(run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    if "work" in run.extra:
        return balance(run, needs, tolerances)
    return Claim("balance", "vacuous", detail="the steps of a scheme of first order keep no energy balance")


def _components(run: Trajectory, law: DeadZoneFlocking, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Within each component velocities agree at the end; a finite run cannot refute the limit."""
    start, end = parts(run.q[0], run.p[0], law), parts(run.q[-1], run.p[-1], law)
    margin = tolerances.velocity - end.mismatch
    status = judge(margin, 0.0, needs)
    return Claim(
        "components",
        "inconclusive" if status == "refuted" else status,
        computed=end.mismatch,
        stated=f"velocities match within each component (K̃ of each <= {tolerances.velocity:g} at the end)",
        margin=margin,
        error=0.0,
        witness={"components": end.count, "K̃ at the start": start.mismatch},
        detail=f"at t = {run.t[-1]:g} the largest K̃ of {end.count} component(s) is {end.mismatch:.3g}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    needs, law = hypotheses(run), dead_zone_law(run)
    if law is None:
        return needs, [Claim(name, "vacuous", detail="another law") for name in _CLAIMS]
    bound = law.interaction.least_distance(float(run.energy()[0])) if needs[1].status == "met" else 0.0
    return needs, [
        _rate(run, law, needs),
        _balance(run, needs, tolerances),
        _components(run, law, needs, tolerances),
        no_collision(run, bound, needs, name="distance"),
    ]


_CLAIMS = ("rate", "balance", "components", "distance")

THEOREM = Theorem(
    id="dead-zone-1-corrected",
    title="Dead-zone flocking corrected: saturated energy, matching within components, explicit distances",
    statement=(
        "With the potential of each pair held constant beyond r, H̄ is continuous and dH̄/dt = -k₂ pᵀL̂p <= 0 across all "
        "switches; velocities match within each component of the net (nothing keeps it connected, as ψ(r) is finite); "
        "from distinct starts no distance falls below 1/(√η sinh(H̄(0)/2k_r + asinh(1/(√η d₁)))), which is positive but "
        "exponentially small."
    ),
    source="ours; repairs Li, Yuan and Liu, Theorem 1",
    kind="trajectory",
    check=_check,
    references=("li-dead-zone",),
)
