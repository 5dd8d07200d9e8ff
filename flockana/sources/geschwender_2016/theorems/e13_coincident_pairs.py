"""Erratum E13: energy bounds the pairs that coincide at one instant, not over time."""

from math import sqrt

import numpy as np

from flockana.environment.targets import StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.theorems.collisions import distinct_pairs, pairs_at_one_instant
from flockana.theorems.hypotheses import alpha_gain
from flockana.theorems.search_objectives import pairs_apart
from flockana.theorems.theorem_toolkit import Checked, Observed, Tolerances, Trajectory, law_is, run_theorem, unmet

_UNTIL = 0.03  # by then both pairs have coincided


def _enclosed(run: Trajectory) -> str | None:
    """Return the id of the interval proof for the one run that the proof covers; None for all other runs."""
    alpha, gains = AlphaInteraction(a=5e4, b=5e4), Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=0.01, c2_gamma=0.01)
    start = np.array([[-12.0], [0.0], [30.0]]), np.array([[sqrt(5.6 * alpha.c_star)], [0.0], [0.0]])
    is_same = all(np.array_equal(*both) for both in zip(start, (run.q[0], run.p[0]), strict=True))
    its_own = is_same and run.law == Algorithm2(alpha, gains, StaticTarget((0.0,))) and run.t[-1] - run.t[0] >= _UNTIL
    return "distinct-pairs" if its_own else None


@run_theorem(
    "E13",
    law=law_is("Algorithm 2", Algorithm2),
    claims=("printed", "corrected"),
    leads={"printed": pairs_apart, "corrected": pairs_apart},
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Theorem 3(iv) says that with H_λ(0) < (k+1) c* at most k distinct pairs could collide. Energy bounds only the
    pairs that coincide at the same instant; one agent can run through several others, one after the other.
    """
    if unmet(requirements := alpha_gain(seen)):
        return requirements, []
    return requirements, [
        distinct_pairs(seen, requirements, tolerances, name="printed", disproof=_enclosed(seen.run)),
        pairs_at_one_instant(seen, requirements, tolerances, name="corrected", proof="collisions"),
    ]
