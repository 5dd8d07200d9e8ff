"""Metrics of one instant of a flock: the quantities of Olfati-Saber (2006)."""

from __future__ import annotations

from typing import Any

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.value_checks import FloatArray, ensure_points, ensure_positive
from flockana.base.vector_norms import centres, lengths, scaled_near_one
from flockana.kernels.connected_components import labelled, squared_excess, unite
from flockana.kernels.extreme_distances import greatest_distances, least_distances
from flockana.kernels.neighbours import pair_blocks

_TREE = 300  # agents from which on a search tree beats all pairs
_SQUARED = 1e-140, 1e150  # between which the square of a speed is a number of full precision


def net_measures(q: Any, d: float, r: float) -> tuple[float, float, float]:
    """Return (C, C*, E) of one net (`connectivity`, `giant_share`, `deviation_energy`) by one neighbour search.

    Examples
    --------
    >>> net_measures([[0.0], [3.0], [9.0]], d=3.0, r=4.0)
    (0.5, 0.6666666666666666, 0.0)
    """
    q, r = ensure_points("q", q), ensure_positive("r", r)
    return _net_measures(q, ensure_positive("d", d), r)


def _net_measures(q: FloatArray, d: float, r: float) -> tuple[float, float, float]:
    q, (d, r), unit = scaled_near_one(q, d, r)
    n, agents, count, excess = len(q), np.arange(len(q)), 0, 0.0
    for first_agents, second_agents in pair_blocks(q, r):
        unite(agents, first_agents, second_agents)
        count, excess = count + first_agents.size, excess + squared_excess(q, first_agents, second_agents, d)
    counts = np.bincount(labelled(agents))
    connectivity = 1.0 if n == 1 else (n - counts.size) / (n - 1)
    return connectivity, float(counts.max()) / n, 2.0 * excess / (2 * count + 1) * unit * unit


def connectivity(q: Any, r: float) -> float:
    """Return the relative connectivity C = rank(L)/(n − 1), from the number of components; 1 for one agent.

    Returns
    -------
    float
        1 if and only if the net is connected.

    Examples
    --------
    >>> connectivity([[0.0], [1.0], [9.0]], 2.0)
    0.5
    """
    return net_measures(q, r, r)[0]


def giant_share(q: Any, r: float) -> float:
    """Return C*, the share of *nodes* in the largest component (E7: the slides print a share of edges).

    Examples
    --------
    >>> giant_share([[0.0], [1.0], [9.0], [20.0]], 2.0)
    0.5
    """
    return net_measures(q, r, r)[1]


def cohesion_radius(q: Any) -> float:
    """Return R = max_i ‖q_i − q_c‖ about the centre of mass.

    Examples
    --------
    >>> cohesion_radius([[0.0, 0.0], [2.0, 0.0]])
    1.0
    """
    return float(cohesion_radii(ensure_points("q", q)[None])[0])


def deviation_energy(q: Any, d: float, r: float) -> float:
    """Return E(q) = Σ over ordered neighbour pairs of (‖q_j − q_i‖ − d)², over their number + 1.

    Returns
    -------
    float
        At most δ² on a quasi-lattice of uncertainty δ.

    Examples
    --------
    >>> deviation_energy([[0.0], [3.0]], d=2.0, r=4.0)  # two ordered pairs: 2·1/(2 + 1)
    0.6666666666666666
    """
    return net_measures(q, d, r)[2]


def velocity_mismatch(p: Any) -> float:
    """Return K = ½ Σ‖p_i − p_c‖².

    Examples
    --------
    >>> velocity_mismatch([[1.0], [3.0]])
    1.0
    """
    return float(spreads(ensure_points("p", p)[None])[0])


def inertia(q: Any) -> float:
    """Return J = ½ Σ‖q_i − q_c‖².

    Examples
    --------
    >>> inertia([[0.0], [2.0]])
    1.0
    """
    return float(spreads(ensure_points("q", q)[None])[0])


def min_distance(q: Any) -> float:
    """Return the least distance between two agents, ∞ for one agent.

    Examples
    --------
    >>> min_distance([[0.0], [3.0], [3.5]])
    0.5
    """
    return float(min_distances(ensure_points("q", q)[None])[0])


def diameter(x: Any) -> float:
    """Return the greatest distance between two agents' positions, or between two agents' velocities.

    Parameters
    ----------
    x : array_like, shape (n, m)
        Positions or velocities.

    Returns
    -------
    float
        0 for one agent.

    Examples
    --------
    >>> diameter([[0.0, 0.0], [3.0, 4.0], [1.0, 1.0]])
    5.0
    """
    return float(diameters(ensure_points("x", x)[None])[0])


def order(p: Any) -> float:
    """Return the polar order ‖Σ p_i/‖p_i‖‖/n: 1 for a common direction; agents at rest count as 0.

    Examples
    --------
    >>> order([[1.0, 0.0], [2.0, 0.0]]), order([[1.0, 0.0], [-2.0, 0.0]])
    (1.0, 0.0)
    """
    return float(orders(ensure_points("p", p)[None])[0])


def coordination(p: Any) -> float:
    """Return Jond's C, the mean cosine between velocities over all pairs of moving agents.

    NaN if fewer than two agents move.

    Examples
    --------
    >>> coordination([[1.0, 0.0], [3.0, 0.0], [0.0, 2.0]])  # cosines 1, 0, 0
    0.3333333333333333
    """
    return float(coordinations(ensure_points("p", p)[None])[0])


def coincident_pairs(q: Any, tol: float) -> int:
    """Return the number of unordered pairs of coincident agents.

    Parameters
    ----------
    tol : float
        Distance below which two agents count as coincident.

    Examples
    --------
    >>> coincident_pairs([[0.0], [0.0], [0.0], [1.0]], 1e-9)
    3
    """
    q = ensure_points("q", q)
    q, (tol,), _ = scaled_near_one(q, ensure_positive("tol", tol))
    return sum(i.size for i, _ in pair_blocks(q, tol))


def pairs_at_one_place(q: Any) -> int:
    """Return the number of unordered pairs of coincident agents.

    Examples
    --------
    >>> pairs_at_one_place([[0.0], [0.0], [0.0], [1.0]])
    3
    """
    counts = np.unique(ensure_points("q", q), axis=0, return_counts=True)[1]
    return int((counts * (counts - 1) // 2).sum())


# The same at every instant of a run, shapes unchecked: x has shape (T, n, m), the result (T,).


@check_kinds
def nets(q: FloatArray, d: float, r: float) -> FloatArray:
    """Return connectivity C, largest-component share C* and deviation energy E at each instant, shape (3, T)."""
    return np.array([_net_measures(x, d, r) for x in q]).T


@check_kinds
def cohesion_radii(q: FloatArray) -> FloatArray:
    """Return the cohesion radius max_i ‖q_i − q_c‖ at each instant, without checks of the input."""
    q, _, unit = scaled_near_one(q)
    return lengths(_centred(q)).max(axis=1) * unit


@check_kinds
def spreads(x: FloatArray) -> FloatArray:
    """Return ½ Σ‖x_i − x_c‖² over time, unchecked: `inertia` of positions, `velocity_mismatch` of velocities.

    Parameters
    ----------
    x : ndarray, shape (T, n, m)
        Positions or velocities.
    """
    return 0.5 * np.sum(_centred(x) ** 2, axis=(1, 2))


@check_kinds
def min_distances(q: FloatArray) -> FloatArray:
    """Return the least distance between two agents at each instant, without checks of the input."""
    q, _, unit = scaled_near_one(q)
    if q.shape[1] < _TREE:
        return least_distances(q) * unit
    from scipy.spatial import KDTree

    return unit * np.array([np.asarray(KDTree(x).query(x, k=2)[0])[:, 1].min() for x in q])


@check_kinds
def diameters(x: FloatArray) -> FloatArray:
    """Return the greatest distance of two agents' positions or velocities at each instant, unchecked.

    Parameters
    ----------
    x : ndarray, shape (T, n, m)
        Positions or velocities.
    """
    x, _, unit = scaled_near_one(x)
    return greatest_distances(np.ascontiguousarray(x)) * unit


@check_kinds
def orders(p: FloatArray) -> FloatArray:
    """Return the polar order ‖Σ p_i/‖p_i‖‖/n at each instant, without checks of the input."""
    return lengths(centres(_headings(p)))


@check_kinds
def coordinations(p: FloatArray) -> FloatArray:
    """Return the mean cosine between velocities of pairs of moving agents at each instant, unchecked."""
    k = np.count_nonzero(np.any(p != 0.0, axis=2), axis=1)
    # |Σ ĥ|² counts every pair twice and every agent once
    doubled_sum = np.sum(_headings(p).sum(axis=1) ** 2, axis=1) - k
    return np.divide(doubled_sum, k * (k - 1), out=np.full(len(p), np.nan), where=k > 1)


def _centred(x: FloatArray) -> FloatArray:
    return x - centres(x)[:, None]


def _headings(p: FloatArray) -> FloatArray:
    """Return unit vectors along the agents' velocities; 0 for agents at rest."""
    with np.errstate(over="ignore"):
        speed = lengths(p)
    is_extreme = ~((speed > _SQUARED[0]) & (speed < _SQUARED[1]))
    if is_extreme.any():
        powers = np.frexp(np.abs(p[is_extreme]).max(axis=1))[1]  # of two: nothing is rounded
        p, speed = p.copy(), speed.copy()
        p[is_extreme] = np.ldexp(p[is_extreme], -powers[:, None])
        speed[is_extreme] = lengths(p[is_extreme][None])[0]
    speed = speed[..., None]
    return np.divide(p, speed, out=np.zeros_like(p), where=speed > 0.0)
