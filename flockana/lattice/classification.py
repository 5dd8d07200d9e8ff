"""Classification of configurations by link lengths: α-lattice, quasi-α-lattice, or neither."""

from math import inf
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_nonnegative, ensure_points, ensure_positive
from flockana.measures import nets
from flockana.measures.nets import LinkArray, link_lengths

GUARD = 1e-12  # relative: above the rounding of lattices of up to 1e6 agents near the origin


def links(q: Any, r: float, *, guard: float = GUARD) -> LinkArray:
    """Return the unordered pairs closer than r beyond rounding, each once with i < j, sorted.

    The neighbour relation is strict, so a pattern may be used up to the very ratio at which second neighbours stand at
    distance r. In floating point they may then stand an ulp closer: here ‖q_j − q_i‖ >= r (1 − guard) counts as r.
    `flockana.measures.nets.links`, which the laws use, compares what is stored: it is this function with guard = 0.

    Parameters
    ----------
    guard : float
        Relative difference from r up to which a distance counts as r; raise it for lattices far from the origin.

    Returns
    -------
    int32 array, shape (M, 2)

    Examples
    --------
    >>> q = 7.0 * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    >>> links(q, 7.0 * np.sqrt(2.0)).tolist()
    [[0, 1], [0, 2]]
    """
    guard = ensure_nonnegative("guard", guard)
    if guard >= 1.0:
        raise ArgumentError(f"guard = {guard:g}: expected a small share of r, below 1")
    return nets.links(q, ensure_positive("r", r) * (1.0 - guard))


def edge_length_error(q: Any, d: float, r: float) -> float:
    """Return δ = max |‖q_j − q_i‖ − d| over the links; NaN without links.

    Returns
    -------
    float
        A length: 0 on an α-lattice, small against d on a quasi-α-lattice.

    Examples
    --------
    >>> edge_length_error([[0.0], [6.5], [20.0]], d=7.0, r=8.4)
    0.5
    """
    q, d = ensure_points("q", q), ensure_positive("d", d)
    distances = link_lengths(q, links(q, r))
    return float(np.abs(distances - d).max()) if distances.size else float("nan")


def strain(q: Any, d: float, r: float) -> float:
    """Return the largest relative error of a link, δ/d; NaN without links.

    Examples
    --------
    >>> strain([[0.0], [3.5]], d=7.0, r=8.4)
    0.5
    """
    return edge_length_error(q, d, r) / ensure_positive("d", d)


def is_alpha_lattice(q: Any, d: float, r: float, tol: float = 1e-9) -> bool:
    """Return whether every link has length d up to rounding; False without links.

    Parameters
    ----------
    tol : float
        Largest |link − d|/d that counts as rounding.

    Examples
    --------
    >>> is_alpha_lattice([[0.0], [7.0], [14.0]], d=7.0, r=8.4), is_alpha_lattice([[0.0], [7.1]], d=7.0, r=8.4)
    (True, False)
    """
    return classify(strain(q, d, r), lattice=ensure_nonnegative("tol", tol), quasi=inf) == "α-lattice"


def classify(strain: float, *, lattice: float, quasi: float) -> str:
    """Return the kind of a configuration from its largest relative link error: α-lattice, quasi-α-lattice, neither.

    Parameters
    ----------
    strain : float
        Largest |link − d|/d; NaN (no links) is neither.
    lattice, quasi : float
        Bounds of the two names.

    Examples
    --------
    >>> classify(1e-9, lattice=1e-6, quasi=0.1), classify(0.03, lattice=1e-6, quasi=0.1)
    ('α-lattice', 'quasi-α-lattice')
    """
    for name, value in (("strain", strain), ("lattice", lattice), ("quasi", quasi)):
        if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
            raise ArgumentError(f"{name} = {format_value(value)}: expected one real number")
    if strain <= lattice:
        return "α-lattice"
    return "quasi-α-lattice" if strain <= quasi else "neither"
