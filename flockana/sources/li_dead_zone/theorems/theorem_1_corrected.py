"""Corrected Theorem 1 of the dead-zone paper: saturated energy, one velocity per component, an explicit distance."""

import numpy as np

from flockana.sources.li_dead_zone.theorems import common_claims as case
from flockana.sources.li_dead_zone.theorems.net_components import Components
from flockana.theorems.claims import by_count, vacuous
from flockana.theorems.energy import balance
from flockana.theorems.theorem_toolkit import (
    Checked,
    Claim,
    Hypothesis,
    Observed,
    Tolerances,
    limit_claim,
    run_theorem,
    unmet,
)


def _rate(seen: Observed, rate: np.ndarray, needs: list[Hypothesis]) -> Claim:
    """Return the claim that the energy rate −k₂ pᵀL̂p is never positive, a sign free of rounding errors."""
    worst, rising_count, energy = int(np.argmax(rate)), int(np.sum(~(rate <= 0.0))), seen.run.energy()
    return by_count("rate", rising_count, needs, proof=None if seen.is_map else case.PROOF).described(
        computed=float(rate[worst]),
        stated="dH̄/dt = -k₂ pᵀL̂p <= 0, across all switches",
        witness={"time": float(seen.t[worst]), "samples at which it is positive": rising_count},
        detail=f"the saturated energy goes from {energy[0]:.6g} to {energy[-1]:.6g}",
    )


def _balance(seen: Observed, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    if "work" in seen.run.extra:
        return balance(seen, needs, tolerances)
    return vacuous("balance", "the steps of a scheme of first order keep no energy balance")


def _components(seen: Observed, end: Components, needs: list[Hypothesis]) -> Claim:
    """Return the claim that velocities match within each component in the limit."""
    return limit_claim("components", needs, [case.settling(end)], computed=end.mismatch).described(
        stated="velocities match within each component: K̃ of each -> 0",
        witness={"components": end.count},
        detail=f"at t = {seen.t[-1]:g} the largest K̃ of {end.count} component(s) is {end.mismatch:.3g}",
    )


@run_theorem(
    "dead-zone-1-corrected",
    title="Dead-zone flocking corrected: saturated energy, matching within components, explicit distances",
    source="ours; repairs Li, Yuan and Liu, Theorem 1",
    law=case.applied,
    claims=("rate", "balance", "components", "distance"),
    references=("li-dead-zone",),
    author="corrected",
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """With the potential of each pair held constant beyond r, H̄ is continuous and dH̄/dt = -k₂ pᵀL̂p <= 0 across all
    switches; velocities match within each component of the net (measured, not proved; nothing keeps the net connected,
    as ψ(r) is finite); from distinct starts no distance falls below 1/(√η sinh(H̄(0)/2k_r + asinh(1/(√η d₁)))), which
    is positive but exponentially small.
    """
    requirements, law = case.hypotheses(seen), case.dead_zone_law(seen.run)
    if law is None or unmet(requirements):
        return requirements, []
    run = seen.run
    rate = np.array([law.flow(float(t), q, p)[1] for t, q, p in zip(run.t, run.q, run.p, strict=True)])
    return requirements, [
        _rate(seen, rate, requirements),
        _balance(seen, requirements, tolerances),
        _components(seen, case.final_components(seen, law), requirements),
        case.no_collision(seen, law, case.distance_bound(seen, law), requirements, name="distance"),
    ]
