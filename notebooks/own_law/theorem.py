"""Its theorem: the mismatch decays at least as fast as the farthest pair allows."""

from __future__ import annotations

import numpy as np
from scipy.spatial.distance import pdist

from flockana import Tolerances, Trajectory
from flockana.theorems import Theorem
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import law_is
from flockana.theorems.theorem import Checked
from own_law.law import CuckerSmale


def check(run: Trajectory, tolerances: Tolerances) -> Checked:
    """K(t) ≤ K(0) exp(−2 g (1 + B²)^−β t), where B is the largest distance of a pair in the run."""
    law = run.law
    B = max(float(pdist(q).max()) for q in run.q)
    rate = 2.0 * law.strength * (1.0 + B**2) ** -law.decay
    K, t = run.energy(), run.t - run.t[0]
    slack = K[0] * np.exp(-rate * t) - K  # 0 at the start, where the two sides are one
    error = float(np.abs(run.energy_residual).max())
    least = float(slack[1:].min()) if len(t) > 1 else float("nan")
    measured = -np.log(K[-1] / K[0]) / t[-1]
    detail = f"B = {B:.4g} allows a rate of {rate:.4g}; the run shows {measured:.4g}"
    return [], [judged("decay", least, error, computed=measured, stated=rate, detail=detail)]


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
