"""The minimal flocking model of the bearing-distance paper: who perceives whom, and sums over directed edges.

An edge is (j, i): j is seen, i sees it. Here `tail` holds the j and `head` the i.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from flockana.kernels.compiling import njit
from flockana.kernels.neighbours import FloatArray, pair_blocks


@njit(cache=True)
def _directed(q, first, second, square):
    """(head, tail) of the edges among some pairs; a pair gives two, one or none: ‖x‖ ≤ R_i, closed."""
    head, tail = np.empty(2 * first.size, np.int64), np.empty(2 * first.size, np.int64)
    count = 0
    for k in range(first.size):
        i, j = first[k], second[k]
        s2 = 0.0
        for c in range(q.shape[1]):
            s2 += (q[j, c] - q[i, c]) ** 2
        if s2 <= square[i]:
            head[count], tail[count] = i, j
            count += 1
        if s2 <= square[j]:
            head[count], tail[count] = j, i
            count += 1
    return head[:count], tail[:count]


def perceived_edges(q: FloatArray, radius: FloatArray) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """(head, tail) of every directed edge: agent head[e] perceives agent tail[e], not farther than its own radius.

    Parameters
    ----------
    q : ndarray, shape (n, m)
        Positions.
    radius : ndarray, shape (n,)
        Perception radius of each agent.

    Examples
    --------
    >>> head, tail = perceived_edges(np.array([[0.0], [2.0]]), np.array([1.0, 2.0]))
    >>> head.tolist(), tail.tolist()
    ([1], [0])
    """
    # the search is strict and the radius closed: a few roundings more than R, and the filter decides
    reach, square = float(radius.max()) * (1.0 + 1e-12), radius * radius
    parts = [_directed(q, i, j, square) for i, j in pair_blocks(q, reach)]
    if len(parts) == 1:
        return parts[0]
    return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])


@njit(cache=True)
def edge_forces(q, p, head, tail, mu, rho, align, u):
    """Add μ (1 − ρ/‖x‖) x + a (p_j − p_i) of each edge, x = q_j − q_i, to u_i; return Σ a ‖p_j − p_i‖² over edges.

    Coincident agents have no bearing: their edge contributes the alignment only.

    Parameters
    ----------
    q, p : ndarray, shape (n, m)
        Positions and velocities.
    head, tail : int64 arrays, shape (M,)
        Edges: the agent i that perceives and the agent j that is perceived.
    mu, rho, align : ndarray, shape (M,)
        Weight μ, desired spacing ρ = α r, and weight a of the velocity difference, of each edge.
    u : ndarray, shape (n, m)
        Changed in place.
    """
    dissipated = 0.0
    m = q.shape[1]
    for e in range(head.size):
        i, j = head[e], tail[e]
        s2, v2 = 0.0, 0.0
        for c in range(m):
            s2 += (q[j, c] - q[i, c]) ** 2
            v2 += (p[j, c] - p[i, c]) ** 2
        w = mu[e] * (1.0 - rho[e] / np.sqrt(s2)) if s2 > 0.0 else 0.0
        for c in range(m):
            u[i, c] += w * (q[j, c] - q[i, c]) + align[e] * (p[j, c] - p[i, c])
        dissipated += align[e] * v2
    return dissipated


@njit(cache=True)
def _count(q, first, second, square, count):
    """Add to the number of agents that each perceives, among some pairs."""
    for k in range(first.size):
        i, j = np.uint64(first[k]), np.uint64(second[k])
        s2 = 0.0
        for c in range(q.shape[1]):
            s2 += (q[j, c] - q[i, c]) ** 2
        count[i] += s2 <= square[i]
        count[j] += s2 <= square[j]


@njit(cache=True, error_model="numpy")
def _pull(q, p, first, second, square, mu, rho, align, u):
    """`edge_forces` of the edges among some pairs, whose weights and lengths are the perceiving agent's."""
    m = q.shape[1]
    for k in range(first.size):
        i, j = np.uint64(first[k]), np.uint64(second[k])
        s2 = 0.0
        for c in range(m):
            s2 += (q[j, c] - q[i, c]) ** 2
        s = np.sqrt(s2)
        for way in range(2):
            head, tail = (i, j) if way == 0 else (j, i)
            if s2 <= square[head]:
                w = mu * (1.0 - rho[head] / s) if s2 > 0.0 else 0.0
                for c in range(m):
                    u[head, c] += w * (q[tail, c] - q[head, c]) + align[head] * (p[tail, c] - p[head, c])


def perceived_forces(
    q: FloatArray,
    p: FloatArray,
    radius: FloatArray,
    spacing: FloatArray,
    shared: bool,
    mu: float,
    sigma: float,
    normalised: bool,
    u: FloatArray,
) -> None:
    """Add to u what `edge_forces` adds for `perceived_edges` that are all heeded alike, without making them.

    Parameters
    ----------
    q, p : ndarray, shape (n, m)
        Positions and velocities.
    radius : ndarray, shape (n,)
        Perception radius of each agent.
    spacing : ndarray, shape (n,)
        Its desired spacing, times the number of those that it perceives if that is `shared`.
    shared : bool
        Whether it grows with that number.
    mu, sigma : float
        Weights of springs and of alignment.
    normalised : bool
        Whether alignment is with the mean, rather than the sum.
    u : ndarray, shape (n, m)
        Changed in place.
    """
    reach, square, count = float(radius.max()) * (1.0 + 1e-12), radius * radius, np.zeros(len(q), np.int64)
    parts = [(i.copy(), j.copy()) for i, j in pair_blocks(q, reach)]
    if shared or normalised:
        for i, j in parts:
            _count(q, i, j, square, count)
    total = sigma * count if normalised else np.ones(len(q))
    align = np.divide(sigma, total, out=np.zeros(len(q)), where=total > 0.0)
    rho = spacing * count if shared else spacing
    for i, j in parts:
        _pull(q, p, i, j, square, mu, rho, align, u)
