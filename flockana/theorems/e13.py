"""Erratum E13: energy bounds the pairs that coincide at one instant, not over time."""

from __future__ import annotations

from flockana.laws.olfati_saber import Algorithm2
from flockana.theorems.asymptotics import distinct_pairs, pairs_at_one_instant
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances
from flockana.trajectory import Trajectory


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) is Algorithm2
    law = Hypothesis("Algorithm 2 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim(name, "vacuous", detail="another law") for name in ("printed", "corrected")]
    c_star = run.law.gains.c1_alpha * run.law.alpha.c_star
    return [law], [
        distinct_pairs(run, law, tolerances, c_star=c_star, name="printed"),
        pairs_at_one_instant(run, law, tolerances, c_star=c_star, name="corrected"),
    ]


THEOREM = Theorem(
    id="E13",
    title="At most k pairs collide at one instant, not in all",
    statement=(
        "Theorem 3(iv) says that with H_λ(0) < (k+1) c* at most k distinct pairs could collide. Energy bounds only the "
        "pairs that coincide at the same instant; one agent can run through several others, one after the other."
    ),
    source="slides, Theorem 3(iv)",
    kind="trajectory",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
)
