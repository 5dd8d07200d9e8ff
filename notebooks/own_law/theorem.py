"""Its theorem: the mismatch decays at least as fast as the farthest pair allows."""

from __future__ import annotations

import numpy as np

from flockana import Tolerances
from flockana.theorems import Theorem
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import law_is
from flockana.theorems.observed_run import Observed
from flockana.theorems.theorem import Checked
from own_law.law import CuckerSmale


def check(seen: Observed, tolerances: Tolerances) -> Checked:
    """K(t) ≤ K(0) exp(−2 g (1 + B²)^−β t), where B is the largest distance of a pair in the run."""
    law, K, t = seen.law, seen.energy, seen.t - seen.t[0]
    B = seen.distances(*np.triu_indices(seen.n, 1)).max()  # between two ends, as all that is seen of a run
    rate = 2.0 * law.strength * (1.0 + B.square()).falling(lambda x: x**-law.decay)
    slack = K[0] * (-rate * t[1:]).exp() - K[1:]  # at the start the two sides are one
    measured = -np.log(K.mid[-1] / K.mid[0]) / t[-1]
    detail = f"B = {B.mid:.4g} allows a rate of {rate.mid:.4g}; the run shows {measured:.4g}"
    return [], [judged("decay", slack, computed=measured, stated=float(rate.mid), detail=detail)]


THEOREM = Theorem(
    id="cucker-smale",
    title="The velocity mismatch decays exponentially",
    statement="K(t) ≤ K(0) exp(−2 g (1 + B²)^−β t) while no pair is farther apart than B.",
    source="after Cucker and Smale 2007; ours",
    kind="trajectory",
    check=check,
    references=(),
    law=law_is("Cucker and Smale's", CuckerSmale),
    claims=("decay",),
)
