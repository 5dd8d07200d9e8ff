"""Printed energy of Algorithm 3 along a run, which can rise (erratum E2)."""

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.laws.algorithm3 import Algorithm3
from flockana.sources.geschwender_2016.theorems.claims_on_energy import run_claim
from flockana.theorems.energy import cancelling, never_rises, stays_outside
from flockana.theorems.gamma_agent_checks import target_rests
from flockana.theorems.theorem_toolkit import Checked, Observed, Tolerances, Trajectory, law_is, lengths, run_theorem


def pair_energy(run: Trajectory) -> FloatArray:
    """Return c1α Σ ψ_α, each pair once, at each sample: the excess of the printed energy."""
    return np.array([run.law.gains.c1_alpha * run.law.alpha.potential_energy(q) for q in run.q])


def _pair_forces(run: Trajectory) -> FloatArray:
    """Return the pair forces −c1α ∇V at each sample."""
    stiffness = run.law.gains.c1_alpha
    return np.array([run.law.alpha.forces(q, 0.0 * q, stiffness=stiffness, damping=0.0)[0] for q in run.q])


def _printed_rate(run: Trajectory) -> FloatArray:
    """Return the rate of the printed energy, including the indefinite surplus c1α ⟨∇V, p⟩."""
    return run.energy_rate() - np.sum(_pair_forces(run) * run.p, axis=(1, 2))


def _cancelling(run: Trajectory) -> FloatArray:
    return cancelling(run) + np.sum(lengths(_pair_forces(run)) * lengths(run.p), axis=1)


@run_theorem(
    "energy-printed",
    title="The energy of Algorithm 3 as printed never rises",
    source="slides, Algorithm 3",
    law=law_is("Algorithm 3", Algorithm3),
    claims=("printed-run",),
    references=("geschwender-2016", "olfati-saber-2006"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """With a γ-agent at rest and all agents outside the obstacles, H with V_α = Σ_i Σ_(j≠i) ψ_α never rises. False
    (E2): the sum counts every pair twice, and the rate of the surplus has no definite sign.
    """
    requirements = [target_rests(seen.run, any_p_r=False), stays_outside(seen)]
    sample_claim = run_claim(seen, pair_energy, f"{seen.n} agents", requirements)
    if sample_claim.status == "refuted":
        return requirements, [sample_claim]
    return requirements, [never_rises(seen, requirements, rate=_printed_rate, cancels=_cancelling, name="printed-run")]
