"""The flocks that everything is measured on: d = 7, r = 8.4, in the plane."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.lattice import triangular

D, R = 7.0, 8.4
NEIGHBOURS = 12  # of an agent of the gas, on average

Flock = tuple[FloatArray, FloatArray]


def lattice(n: int, seed: int = 0) -> Flock:
    """The triangular lattice, disturbed by 3 % of d, with 6 neighbours each, row by row."""
    rng = np.random.default_rng(seed)
    return triangular(n, D) + 0.03 * D * rng.standard_normal((n, 2)), rng.uniform(-1.0, 1.0, (n, 2))


def shuffled(n: int, seed: int = 0) -> Flock:
    """The same lattice with its agents in no order."""
    q, p = lattice(n, seed)
    order = np.random.default_rng(seed + 1).permutation(n)
    return np.ascontiguousarray(q[order]), np.ascontiguousarray(p[order])


def gas(n: int, seed: int = 0) -> Flock:
    """Agents anywhere in a square, with 12 neighbours each on average, in no order."""
    rng = np.random.default_rng(seed)
    side = R * np.sqrt(np.pi * n / NEIGHBOURS)
    return rng.uniform(0.0, side, (n, 2)), rng.uniform(-1.0, 1.0, (n, 2))


FLOCKS: dict[str, Callable[[int], Flock]] = {"lattice": lattice, "shuffled lattice": shuffled, "gas": gas}
