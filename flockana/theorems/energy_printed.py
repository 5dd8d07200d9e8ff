"""The energy of Algorithm 3 as the slides print it, along a run: erratum E2 says that it can rise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flockana.laws.algorithm3 import Algorithm3
from flockana.theorems.energy import at_rest, stays_outside
from flockana.theorems.printed_energy import run_claim
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) is Algorithm3
    law = Hypothesis("Algorithm 3 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim("printed-run", "vacuous", detail="another law")]
    needs = [law, at_rest(run), stays_outside(run)]
    pairs = np.array([run.law.gains.c1_alpha * run.law.alpha.potential_energy(q) for q in run.q])
    claim = run_claim(run, pairs, f"{run.n} agents")
    if claim.margin == 0.0:  # it never was above its start: how clearly it falls, in its slowest step
        claim = replace(claim, margin=-float(np.diff(run.energy() + pairs).max()))
        claim = replace(claim, status=judge(claim.margin or 0.0, claim.error or 0.0, needs))
    if any(need.status == "unmet" for need in needs):
        claim = replace(claim, status="vacuous")
    return needs, [claim]


THEOREM = Theorem(
    id="energy-printed",
    title="The energy of Algorithm 3 as printed never rises",
    statement=(
        "With a γ-agent at rest and all agents outside the obstacles, H with V_α = Σ_i Σ_(j≠i) ψ_α never rises. False "
        "(E2): the sum counts every pair twice, and what it has too much has no sign."
    ),
    source="slides, Algorithm 3",
    kind="trajectory",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
)
