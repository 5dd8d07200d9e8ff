"""The grade that the search minimises: a number for each run, lower the nearer it comes to refuting the claim.

Refuted runs are graded in [-3, -2], judged ones in (-1, 1.001], vacuous ones from 2 on, failed ones 1000. So a search
that leaves the hypotheses is led back by how far they are missed, and comes to the margin when they are met.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import isnan

from flockana.theorems import Claim, Hypothesis
from flockana.theorems.leads import squash

FAILED = 1000.0
_REFUTED, _VACUOUS = -2.0, 2.0
_LEAD = 1e-3  # of a surrogate: less than a step of any count, so it orders only what the margin leaves equal


def grade(
    claim: Claim, hypotheses: Iterable[Hypothesis], *, scale: float = 1.0, lead: float = 0.0, limit: bool = False
) -> float:
    """The grade of one claim on one run.

    Examples
    --------
    >>> near, far = Claim("i", "verified", margin=0.1), Claim("i", "verified", margin=5.0)
    >>> grade(near, []) < grade(far, []) < grade(Claim("i", "vacuous"), [])
    True
    """
    margin = float("nan") if claim.margin is None else float(claim.margin)
    if claim.status == "vacuous":
        return _VACUOUS + missing(hypotheses) + _LEAD * lead
    if claim.status == "refuted":
        return _REFUTED + (squash(margin / scale) if margin < 0.0 else 0.0)
    if limit:
        return lead
    if isnan(margin):
        return (1.0 if claim.status == "verified" else 0.0) + _LEAD * lead
    return squash(margin / scale) + _LEAD * lead


def missing(hypotheses: Iterable[Hypothesis]) -> float:
    """Return the total shortfall of unmet hypotheses, each between 0 and 1.

    Examples
    --------
    >>> missing([Hypothesis("a", "unmet", -3.0), Hypothesis("b", "unmet"), Hypothesis("c", "met", 1.0)])
    1.75
    """
    unmet = [h.margin for h in hypotheses if h.status == "unmet"]
    return float(sum(1.0 if margin is None or isnan(margin) else squash(abs(margin)) for margin in unmet))
