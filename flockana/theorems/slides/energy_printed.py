"""The energy of Algorithm 3 as the slides print it, along a run: erratum E2 says that it can rise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flockana.base.vectors import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.algorithm3 import Algorithm3
from flockana.theorems.hypotheses import law_is
from flockana.theorems.olfati_saber.energy import cancelling, falling_share, stays_outside
from flockana.theorems.olfati_saber.gamma_agent import target_rests
from flockana.theorems.slides.claims_on_energy import run_claim
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, judge


def _by_rate(run: Trajectory, claim: Claim, needs: list[Hypothesis]) -> Claim:
    """The claim by the rate in closed form, which must be negative wherever anything moves.

    V_α too much adds c1α ⟨∇V, p⟩ to the rate, which has no sign.
    """
    stiffness = run.law.gains.c1_alpha
    forces = np.array([run.law.alpha.forces(q, 0.0 * q, stiffness=stiffness, damping=0.0)[0] for q in run.q])
    power = np.array([float(np.vdot(u, p)) for u, p in zip(forces, run.p, strict=True)])
    turned = lengths(forces) * lengths(run.p)
    share, error = falling_share(run, run.energy_rate() - power, cancelling(run) + turned.sum(axis=1))
    margin = float(share.min())
    status = judge(margin, error, needs)
    return replace(claim, status="inconclusive" if status == "refuted" else status, margin=margin, error=error)


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs = [target_rests(run, told=False), stays_outside(run)]
    pairs = np.array([run.law.gains.c1_alpha * run.law.alpha.potential_energy(q) for q in run.q])
    claim = run_claim(run, pairs, f"{run.n} agents", needs)
    return needs, [_by_rate(run, claim, needs) if claim.status == "inconclusive" else claim]


THEOREM = Theorem(
    id="energy-printed",
    title="The energy of Algorithm 3 as printed never rises",
    statement=(
        "With a γ-agent at rest and all agents outside the obstacles, H with V_α = Σ_i Σ_(j≠i) ψ_α never rises. False "
        "(E2): the sum counts every pair twice, and what it has too much has no sign."
    ),
    source="slides, Algorithm 3",
    kind="trajectory",
    law=law_is("Algorithm 3", Algorithm3),
    check=_check,
    claims=("printed-run",),
    references=("geschwender-2016", "olfati-saber-2006"),
)
