"""Random starts of ten agents as in section 5.1 of the bearing-distance paper, and runs from twenty of them."""

from collections.abc import Callable

import numpy as np

from flockana.measures.nets import components, links
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.theorems.theorem_toolkit import FloatArray, Trajectory, observed

SEEDS, DURATION = 20, 20.0  # runs of an ensemble; s


def zone_start(seed: int) -> tuple[FloatArray, FloatArray]:
    """Return the random start of section 5.1 of the paper: q in (0, 10)² m, p in (0, 1)² m/s by component."""
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, 10.0, (10, 2)), rng.uniform(0.0, 1.0, (10, 2))


def separated_start(seed: int, n: int = 10) -> tuple[FloatArray, FloatArray]:
    """Return a random start with no two agents closer than 2 m and the net within 5 m connected."""
    rng = np.random.default_rng(seed)
    while True:
        q = rng.uniform(0.0, 10.0, (1, 2))
        for x in rng.uniform(0.0, 10.0, (100 * n, 2)):
            if len(q) < n and np.linalg.norm(q - x, axis=1).min() > 2.0:
                q = np.vstack([q, x])
        if len(q) == n and not components(n, links(q, 5.0)).any():
            return q, rng.uniform(0.0, 1.0, (n, 2))


def crowd_start(seed: int, n: int, *, any_direction: bool = False) -> tuple[FloatArray, FloatArray]:
    """Return a start of n agents as dense as ten in (0, 10)² m, no two closer than 2 m."""
    # Velocities are in (0, 1)² m/s, as printed, or in (−1, 1)².
    rng = np.random.default_rng(seed)
    side = 10.0 * np.sqrt(n / 10.0)
    q = rng.uniform(0.0, side, (1, 2))
    while len(q) < n:
        x = rng.uniform(0.0, side, 2)
        if np.linalg.norm(q - x, axis=1).min() > 2.0:
            q = np.vstack([q, x])
    return q, rng.uniform(-1.0 if any_direction else 0.0, 1.0, (n, 2))


def runs_from_random_starts(
    law: ZoneFlocking, start: Callable[[int], tuple[FloatArray, FloatArray]] = zone_start
) -> list[Trajectory]:
    """Run 20 s from each of twenty random starts."""
    return [observed(law, *start(seed), (0.0, DURATION)).run for seed in range(SEEDS)]
