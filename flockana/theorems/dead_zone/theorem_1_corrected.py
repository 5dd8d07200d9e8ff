"""Theorem 1 of the dead-zone paper, repaired: saturated energy, one velocity per component, an explicit distance."""

from __future__ import annotations

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.claims import judged
from flockana.theorems.dead_zone.case import PROOF, dead_zone_law, final_components, hypotheses, no_collision, settling
from flockana.theorems.dead_zone.parting import Components
from flockana.theorems.limits import limit_claim
from flockana.theorems.olfati_saber.energy import balance
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet


def _rate(run: Trajectory, rate: np.ndarray, needs: list[Hypothesis]) -> Claim:
    """−k₂ pᵀL̂p is a sum of squares: no rounding can change its sign, and samples where it has another are counted."""
    worst, rising = int(np.argmax(rate)), int(np.sum(~(rate <= 0.0)))
    return judged(
        "rate",
        float(-rising or 1),
        0.0,
        needs,
        computed=float(rate[worst]),
        stated="dH̄/dt = -k₂ pᵀL̂p <= 0, across all switches",
        witness={"time": float(run.t[worst]), "samples at which it is positive": rising},
        proof=PROOF,
        detail=f"the saturated energy goes from {run.energy()[0]:.6g} to {run.energy()[-1]:.6g}",
    )


def _balance(run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    if "work" in run.extra:
        return balance(run, needs, tolerances)
    return Claim("balance", "vacuous", detail="the steps of a scheme of first order keep no energy balance")


def _components(run: Trajectory, end: Components, needs: list[Hypothesis]) -> Claim:
    """Within each component velocities match in the end; a finite run cannot refute the limit."""
    return limit_claim(
        "components",
        needs,
        [settling(end)],
        computed=end.mismatch,
        stated="velocities match within each component: K̃ of each -> 0",
        witness={"components": end.count},
        detail=f"at t = {run.t[-1]:g} the largest K̃ of {end.count} component(s) is {end.mismatch:.3g}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs, law = hypotheses(run), dead_zone_law(run)
    if law is None or unmet(needs):
        return needs, []
    rate = np.array([law.flow(float(t), q, p)[1] for t, q, p in zip(run.t, run.q, run.p, strict=True)])
    bound = law.interaction.least_distance(float(run.energy()[0]))
    return needs, [
        _rate(run, rate, needs),
        _balance(run, needs, tolerances),
        _components(run, final_components(run, law), needs),
        no_collision(run, bound, law.scales.length, needs, name="distance"),
    ]


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
    claims=("rate", "balance", "components", "distance"),
    references=("li-dead-zone",),
)
