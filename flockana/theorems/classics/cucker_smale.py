"""Cucker and Smale (2007): with an influence that decays slowly every start becomes a flock."""

from __future__ import annotations

from math import sqrt

from flockana.laws.cucker_smale import CuckerSmale
from flockana.theorems.classics.alignment_bounds import Guarantee
from flockana.theorems.hypotheses import condition, law_is
from flockana.theorems.observed import Observed
from flockana.theorems.theorem import Checked, Theorem, Tolerances, unmet


def _check(seen: Observed, tolerances: Tolerances) -> Checked:
    beta = seen.law.weight.decay
    needs = [condition("β < ½", beta < 0.5, 0.5 - beta, f"β = {beta:g}")]
    if unmet(needs):
        return needs, []
    guarantee = Guarantee(seen, sqrt(2.0))
    bounded, _, velocities = guarantee.claims(("bounded", "rate", "velocities"), needs, proof="cucker-smale")
    return needs, [bounded, velocities]


THEOREM = Theorem(
    id="cucker-smale",
    title="For β < ½ every start becomes a flock",
    statement=(
        "Under the Cucker-Smale law, a(s) = K/(σ² + s²)^β with β < ½, distances of agents are bounded for all times, "
        "velocities tend to a common one, and every q_j - q_i has a limit, from any start. The bound is checked "
        "with one that is known: ‖x‖ <= x_M of the functional of Ha and Liu. What the paper says of β >= ½, under a "
        "condition on the start, is checked as Ha and Liu say it."
    ),
    source="Cucker and Smale 2007",
    kind="trajectory",
    law=law_is("the Cucker-Smale law", CuckerSmale),
    check=_check,
    claims=("bounded", "velocities"),
    references=("cucker-smale-2007",),
)
