"""Cucker and Smale (2007): with an influence that decays slowly every start becomes a flock, exponentially fast."""

from math import sqrt

from flockana.sources.cucker_smale_2007.laws import CuckerSmale
from flockana.sources.cucker_smale_2007.theorems.spread_functional import guarantee_of
from flockana.theorems.theorem_toolkit import Checked, Observed, Tolerances, condition, law_is, run_theorem


@run_theorem(
    "cucker-smale",
    title="For β <= ½ every start becomes a flock, at an exponential rate",
    source="Cucker and Smale 2007",
    law=law_is("the Cucker-Smale law", CuckerSmale),
    claims=("bounded", "rate", "velocities"),
    references=("cucker-smale-2007",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Under the Cucker-Smale law, a(s) = K/(σ² + s²)^β with β < ½, distances of agents are bounded for all times,
    velocities tend to a common one at an exponential rate, and every q_j - q_i has a limit, from any start. Bound and
    rate are those of the functional of Ha and Liu, ‖x‖ <= x_M and φ(x_M), by which the same holds at β = ½ without the
    paper's condition on the start. What the paper says of β > ½, under such a condition, is checked as Ha and Liu say
    it (ha-liu).
    """
    beta = seen.law.weight.decay
    return guarantee_of(seen, sqrt(2.0)).claims([condition("β <= ½", beta <= 0.5, 0.5 - beta, f"β = {beta:g}")])
