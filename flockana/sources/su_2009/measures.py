"""Share of a flock that follows its leader."""

from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.measures.measure import Measure

FOLLOWS = 1e-2  # of the law's own speed: an agent this near to the leader's velocity follows it


def following(run: Any) -> FloatArray:
    """Return which agents match their leader's velocity at the end, within 1/100 of the law's speed, shape (n,)."""
    rate = run.law.target.rate(float(run.t[-1]))
    return np.linalg.norm(run.p[-1] - rate, axis=1) <= FOLLOWS * run.scales.speed


MEASURES = (
    Measure(
        "followers",
        "share of agents that follow the leader",
        of_run=lambda run: float(np.mean(following(run))),
        of_run_text="share of agents with the leader's velocity at the end, within 1/100 of the law's speed",
        defined=lambda law: law.target is not None,
        at_most_one=True,
    ),
)
