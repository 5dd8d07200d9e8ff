"""Olfati-Saber and Murray: average consensus on switching balanced nets."""

from flockana.laws.scheduled_laws import VelocityInTurn
from flockana.sources.olfati_saber_murray_2004.laws import AverageConsensus
from flockana.sources.olfati_saber_murray_2004.theorems.average_consensus import (
    average,
    decay,
    is_balanced,
    is_strong,
    slowest_rate,
)
from flockana.theorems.theorem_toolkit import Checked, Hypothesis, Observed, Tolerances, condition, run_theorem, unmet


def _nets_in_turn(seen: Observed) -> Hypothesis:
    law = seen.law
    is_consensus = type(law) is VelocityInTurn and all(type(item) is AverageConsensus for item in law.laws)
    return condition("consensus of the first order over nets in turn is applied", is_consensus, detail=law.title)


def _of_all(needs: list[Hypothesis]) -> Hypothesis:
    """Return one hypothesis on all switching nets: the first unmet one of a net, or else the last."""
    worst = unmet(needs) or needs[-1]
    name = worst.name.replace("the net is", "every net is")
    return condition(name, worst.status == "met", worst.margin, f"net {needs.index(worst)}: {worst.detail}")


@run_theorem(
    "average-switching",
    title="Consensus over balanced nets in turn is the average of the start, whatever the order and the lengths",
    source="Olfati-Saber and Murray 2004, in our words",
    law=_nets_in_turn,
    claims=("average", "decay"),
    references=("olfati-saber-murray-2004",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let q' = -L(t)q, where L(t) is at each time the Laplacian of one of finitely many digraphs, all of them balanced
    and strongly connected. In whatever order and for whatever times they act, all tend to the average of the start, and
    the disagreement falls at the least λ₂ of (L + Lᵀ)/2 or faster.
    """
    laws = seen.law.laws
    needs = [_of_all([is_balanced(law.weights) for law in laws]), _of_all([is_strong(law.weights) for law in laws])]
    rate = min(slowest_rate(law.laplacian) for law in laws)
    return needs, [average(seen, needs), decay(seen, needs, rate)]
