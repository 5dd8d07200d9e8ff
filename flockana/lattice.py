"""α-lattices: configurations in which all neighbours are at distance d."""

from __future__ import annotations

from math import isqrt
from typing import Any

import numpy as np

from flockana.checks import FloatArray, ensure_positive
from flockana.errors import ArgumentError

_STEPS = np.array(
    [(1.0, 0.0), (0.5, 0.75**0.5), (-0.5, 0.75**0.5), (-1.0, 0.0), (-0.5, -(0.75**0.5)), (0.5, -(0.75**0.5))]
)


def ensure_count(name: str, value: Any) -> int:
    """Return `value` as a whole number >= 1.

    Parameters
    ----------
    name : str
        The argument's name, for the message.
    value : object
        What the caller gave.

    Raises
    ------
    ArgumentError
        If it is no whole number >= 1.

    Examples
    --------
    >>> ensure_count("n", 7)
    7
    """
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 1:
        raise ArgumentError(f"{name} = {value!r}: expected a whole number >= 1")
    return int(value)


def hexagonal_spiral(n: int, d: float) -> FloatArray:
    """The first n points of a spiral on the triangular lattice: it has Harborth's largest number of links.

    Parameters
    ----------
    n : int
        Number of agents.
    d : float
        Distance between neighbours.

    Returns
    -------
    ndarray, shape (n, 2)

    Examples
    --------
    >>> from flockana.nets import links
    >>> len(links(hexagonal_spiral(19, 7.0), 8.4)) == harborth(19)
    True
    """
    n, d = ensure_count("n", n), ensure_positive("d", d)
    points, ring = [np.zeros(2)], 0
    while len(points) < n:
        ring += 1
        here = ring * _STEPS[0]  # the last point of the ring: its first lies between two of the ring inside
        for side in range(6):
            for _ in range(ring):
                here = here + _STEPS[(side + 2) % 6]
                points.append(here)
    return d * np.array(points[:n])


def hexagonal_patch(k: int, d: float) -> FloatArray:
    """A hexagon of the triangular lattice with k rings about its centre: 3k(k + 1) + 1 agents.

    Parameters
    ----------
    k : int
        Number of rings, >= 0.
    d : float
        Distance between neighbours.

    Returns
    -------
    ndarray, shape (3k(k + 1) + 1, 2)

    Examples
    --------
    >>> hexagonal_patch(1, 7.0).shape
    (7, 2)
    """
    k = ensure_count("k", k) if k != 0 else 0
    return hexagonal_spiral(3 * k * (k + 1) + 1, d)


def harborth(n: int) -> int:
    """Largest number of links of a planar α-lattice of n agents: ⌊3n − √(12n − 3)⌋   (Harborth 1974).

    Parameters
    ----------
    n : int
        Number of agents.

    Examples
    --------
    >>> [harborth(n) for n in (1, 2, 3, 7, 19)]
    [0, 1, 3, 12, 42]
    """
    n = ensure_count("n", n)
    root = isqrt(12 * n - 3)  # ⌊3n − √x⌋ = 3n − ⌈√x⌉, in whole numbers
    return 3 * n - (root if root * root == 12 * n - 3 else root + 1)
