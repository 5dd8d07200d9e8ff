"""A measure in one file."""

import numpy as np

from flockana.measures.measure import Measure

MEASURES = (
    Measure(
        "toy_reach",
        "farthest from the origin",
        "length",
        over_time=lambda flock: np.linalg.norm(flock.q, axis=2).max(axis=1),
    ),
)
