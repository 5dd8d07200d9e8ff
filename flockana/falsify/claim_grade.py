"""Grade of a run, minimised by the search: lower the nearer the run comes to refuting a claim.

Refuted runs are graded in [-3, -2], judged ones in (-1, 1.001], vacuous ones from 2 on, failed ones 1000. So a search
that leaves the hypotheses is led back by how far they are missed, and comes to the margin when they are met. A run
whose numbers contradict a proof is no counterexample, and its margin leads no search.
"""

from collections.abc import Iterable
from math import isnan

from flockana.theorems import Claim, Hypothesis
from flockana.theorems.search_objectives import squash

FAILED = 1000.0
_REFUTED, _VACUOUS = -2.0, 2.0
_LEAD = 1e-3  # of a surrogate: less than a step of any count, so it orders only what the margin leaves equal


def grade(claim: Claim, hypotheses: Iterable[Hypothesis], *, scale: float = 1.0, lead: float | None = None) -> float:
    """Return the grade of a claim on a run: lower the nearer the run comes to refuting the claim."""
    # A claim about a limit that has a lead is graded by it: how well a limit is known tells nothing of what it is.
    margin = float("nan") if claim.margin is None else float(claim.margin)
    aid = 0.0 if lead is None else _LEAD * lead
    if claim.status == "vacuous":
        return _VACUOUS + shortfall(hypotheses) + aid
    if claim.status == "refuted":
        return _REFUTED + (squash(margin / scale) if margin < 0.0 else 0.0)
    if claim.about == "limit" and lead is not None:
        return lead
    if isnan(margin) or claim.contradicts:
        return (1.0 if claim.status == "verified" else 0.0) + aid
    return squash(margin / scale) + aid


def shortfall(hypotheses: Iterable[Hypothesis]) -> float:
    """Return by how much a theorem's unmet hypotheses are missed, summed, at most 1 for each."""
    unmet_margins = [h.margin for h in hypotheses if h.status == "unmet"]
    return float(sum(1.0 if margin is None or isnan(margin) else squash(abs(margin)) for margin in unmet_margins))
