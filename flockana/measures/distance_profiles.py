"""Quantiles of all pair distances over time, for any number of agents."""

from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, Numbers, ensure_numbers

_DISTANCES = 2**17  # that are held at once, at most, unless those of one instant are more
QUARTERS = (0.0, 0.25, 0.5, 0.75, 1.0)


def pair_distance_profile(q: Any, shares: Numbers = QUARTERS) -> FloatArray:
    """Return quantiles of all pair distances at each instant, shape (T, number of shares); NaN for one agent."""
    from scipy.spatial.distance import pdist

    positions = ensure_numbers("q", q, "numbers, in arrays")
    expectation = ensure_numbers("shares", shares, "numbers, in arrays")
    if positions.ndim != 3:
        raise ArgumentError(f"q has shape {positions.shape}: expected (T, n, m), positions over time")
    if expectation.ndim != 1 or not ((expectation >= 0.0) & (expectation <= 1.0)).all():
        raise ArgumentError(f"shares = {shares!r}: expected numbers from 0 to 1")
    if positions.shape[1] < 2:
        return np.full((len(positions), expectation.size), np.nan)
    profile = np.empty((len(positions), expectation.size))
    at_once = max(1, 2 * _DISTANCES // positions.shape[1] ** 2)
    for first in range(0, len(positions), at_once):  # a call of np.quantile costs as much as thousands of distances
        block = slice(first, first + at_once)
        profile[block] = np.quantile([pdist(instant) for instant in positions[block]], expectation, axis=1).T
    return profile
