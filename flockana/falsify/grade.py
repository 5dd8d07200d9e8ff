"""What the search minimises: one number for each run, lower the nearer the run comes to breaking the claim.

Refuted runs are graded in [-3, -2], judged ones in (-1, 1.001], vacuous ones from 2 on, failed ones 1000. So a search
that leaves the hypotheses is led back by how far they are missed, and comes to the margin when they are met.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from math import isfinite, isnan

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.measures.nets import links
from flockana.theorems import Claim, Hypothesis
from flockana.theorems.olfati_saber.collisions import met
from flockana.theorems.theorem import Tolerances

Lead = Callable[[Trajectory, Claim], float]
FAILED = 1000.0
_REFUTED, _VACUOUS = -2.0, 2.0
_LEAD = 1e-3  # of a surrogate: less than a step of any count, so it orders only what the margin leaves equal


def squash(x: float) -> float:
    """x/(1 + |x|): keeps the order, and has a place for infinity.

    Parameters
    ----------
    x : float
        Any number, NaN excepted.

    Examples
    --------
    >>> squash(1.0), squash(-3.0), squash(float("inf"))
    (0.5, -0.75, 1.0)
    """
    return x / (1.0 + abs(x)) if isfinite(x) else (1.0 if x > 0.0 else -1.0)


def grade(
    claim: Claim, hypotheses: Iterable[Hypothesis], *, scale: float = 1.0, lead: float = 0.0, limit: bool = False
) -> float:
    """The grade of one claim on one run.

    Parameters
    ----------
    claim : Claim
        As judged.
    hypotheses : iterable of Hypothesis
        Of its theorem; where the claim is vacuous, the unmet ones say how far away it is.
    scale : float
        Unit of the margin, > 0.
    lead : float
        A surrogate's value in [0, 1]; see `LEADS`.
    limit : bool
        Whether it is about a limit. Until one is certain that is none, its margin says how well the limit is known, not
        how near the claim is to breaking: then the surrogate alone counts.

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
    """How far hypotheses are from being met: the sum over the unmet ones, each below 1, or 1 if it has no margin.

    Parameters
    ----------
    hypotheses : iterable of Hypothesis
        As found.

    Examples
    --------
    >>> missing([Hypothesis("a", "unmet", -3.0), Hypothesis("b", "unmet"), Hypothesis("c", "met", 1.0)])
    1.75
    """
    unmet = [h.margin for h in hypotheses if h.status == "unmet"]
    return float(sum(1.0 if margin is None or isnan(margin) else squash(abs(margin)) for margin in unmet))


def pairs_apart(run: Trajectory, claim: Claim) -> float:
    """For a count of pairs that meet: how far the nearest pair stays apart that has not met, over d.

    Parameters
    ----------
    run : Trajectory
        The run.
    claim : Claim
        Not used.
    """
    i, j = np.triu_indices(run.n, 1)
    apart = np.linalg.norm(run.q[:, i] - run.q[:, j], axis=2).min(axis=0)
    done = {(c.i, c.j) for c in met(run, Tolerances())}
    open_ones = [x for x, a, b in zip(apart.tolist(), i.tolist(), j.tolist(), strict=True) if (a, b) not in done]
    return squash(min(open_ones, default=0.0) / run.law.alpha.d)


def bridge(run: Trajectory, claim: Claim) -> float:
    """For a count of components: how far below r the longest link that holds the flock together stays.

    Parameters
    ----------
    run : Trajectory
        The run.
    claim : Claim
        Not used.
    """
    from scipy.sparse.csgraph import minimum_spanning_tree
    from scipy.spatial.distance import pdist, squareform

    longest = max(float(minimum_spanning_tree(squareform(pdist(q))).max()) for q in run.q) if run.n > 1 else 0.0
    return 1.0 - squash(longest / run.law.alpha.r)


def strained(run: Trajectory, claim: Claim) -> float:
    """For the lattice as a limit: how soon links are unstrained, 1 less the mean over time of the largest strain.

    Runs that pass by a strained equilibrium linger there: the longer they do, the nearer they are to its basin.

    Parameters
    ----------
    run : Trajectory
        The run.
    claim : Claim
        Not used.
    """
    alpha, series = run.law.alpha, []
    for q in run.q:
        pairs = links(q, alpha.r)
        lengths = np.linalg.norm(q[pairs[:, 0]] - q[pairs[:, 1]], axis=1)
        series.append(float(np.abs(lengths / alpha.d - 1.0).max(initial=0.0)))
    return 1.0 - float(np.trapezoid(np.minimum(series, 1.0), run.t)) / float(run.t[-1] - run.t[0])


# margins that are counts, or the same on all runs but the refuted ones, give a search no slope: these do
LEADS: Mapping[str, Lead] = {
    "os-3:iv-printed": pairs_apart,
    "os-3:iv-instant": pairs_apart,
    "E13:printed": pairs_apart,
    "E13:corrected": pairs_apart,
    "alpha-flocking:giant": bridge,
    "alpha-flocking-strict:flock": bridge,
    "os-1:i": strained,
    "lattice-limit-printed:lattice": strained,
}
LIMITS = frozenset({"os-1:i", "lattice-limit-printed:lattice"})  # claims about limits that a run may refute
