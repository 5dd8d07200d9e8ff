"""Ratio of the circle or sine of the centre of mass to the γ-agent's, enclosed (E12, E15)."""

from typing import Any

import numpy as np

from flockana.stability.centre_path import motion
from flockana.stability.tracking import response_ratio
from flockana.theorems.second_runs import DOUBT
from flockana.theorems.toolkit import Enclosure, Observed


def measured_ratio(seen: Observed) -> Enclosure:
    """Return the ratio that a run shows; its error is the fit's residual and the difference of two runs."""
    (ratio, left), (other, _) = response_ratio(seen.run), response_ratio(seen.other)
    target: Any = seen.law.target
    floor = 0.0 if seen.is_map else seen.floors.place / float(np.linalg.norm(motion(target).swing))
    return Enclosure.around(ratio, np.inf if seen.doubt else left + DOUBT * abs(ratio - other) + floor)
