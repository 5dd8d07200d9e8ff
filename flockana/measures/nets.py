"""Neighbour graphs of a configuration: links, components, Laplacian, in time and memory linear in the links.

N_i holds j ≠ i with ‖q_j − q_i‖ < r (strict). The paper's |E| counts ordered pairs (i, j) and (j, i); a *link* here
is an unordered pair, so |E| is twice the number of links.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import (
    FloatArray,
    ensure_count,
    ensure_links,
    ensure_points,
    ensure_positive,
    ensure_series,
)
from flockana.base.vector_norms import lengths, scaled_near_one
from flockana.kernels.connected_components import labelled, unite
from flockana.kernels.neighbours import pair_list

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_PRIME = 2147483647  # a rank modulo 2³¹ − 1 is exact unless that divides every minor of its size
LinkArray = npt.NDArray[np.int32]


def links(q: Any, r: float) -> LinkArray:
    """Return the unordered pairs closer than r, each once with i < j, sorted.

    Parameters
    ----------
    r : float
        Interaction range; strict.

    Returns
    -------
    int32 array, shape (M, 2)

    Examples
    --------
    >>> links([[0.0], [1.0], [2.5]], 1.2).tolist()
    [[0, 1]]
    """
    q, (r,), _ = scaled_near_one(ensure_points("q", q), ensure_positive("r", r))
    return np.column_stack(pair_list(q, r))


def link_lengths(q: FloatArray, pairs: LinkArray) -> FloatArray:
    """Return the Euclidean length of each link."""
    q, _, unit = scaled_near_one(q)
    return lengths(q[pairs[:, 1]] - q[pairs[:, 0]]) * unit


def components(n: int, pairs: LinkArray) -> npt.NDArray[np.int32]:
    """Return the component label of each of n agents, counted from 0.

    Parameters
    ----------
    pairs : int array, shape (M, 2)

    Examples
    --------
    >>> components(3, links([[0.0], [1.0], [9.0]], 2.0)).tolist()
    [0, 0, 1]
    """
    n = ensure_count("n", n)
    pairs, agents = ensure_links(pairs, n), np.arange(n)
    unite(agents, pairs[:, 0], pairs[:, 1])
    return labelled(agents)


def laplacian(n: int, pairs: LinkArray, weights: FloatArray | None = None) -> csr_array:
    """Return the graph Laplacian L = Δ(A) − A, sparse.

    Parameters
    ----------
    pairs : int array, shape (M, 2)
    weights : ndarray, shape (M,), optional
        a_ij of each link; 1 by default.

    Examples
    --------
    >>> laplacian(2, np.array([[0, 1]], dtype=np.int32)).toarray().tolist()
    [[1.0, -1.0], [-1.0, 1.0]]
    """
    from scipy.sparse import coo_array, diags_array

    n = ensure_count("n", n)
    pairs = ensure_links(pairs, n)
    a = np.ones(len(pairs)) if weights is None else ensure_series("weights", weights, len(pairs))
    half_matrix = coo_array((a, (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    adjacency = (half_matrix + half_matrix.T).tocsr()
    return (diags_array(adjacency.sum(axis=1)) - adjacency).tocsr()


def printed_edge_share(n: int, pairs: LinkArray) -> float:
    """Return C* = |E(Γ*)|/|E(G)| as the slides print it: share of *links* in the largest component (E7)."""
    # With isolated agents it is 1 whenever only one component has links, which is why the slides' own example (0.96 for
    # components of 1, 1, 1, 1, 96) needs the share of nodes, `metrics.giant_share`.
    n = ensure_count("n", n)
    pairs = ensure_links(pairs, n)
    if len(pairs) == 0:
        return float("nan")
    labels = components(n, pairs)
    giant_label = int(np.argmax(np.bincount(labels)))
    return float(np.mean(labels[pairs[:, 0]] == giant_label))


def printed_rank_connectivity(n: int, pairs: LinkArray, *, typeset: bool = False) -> float:
    """Return C = rank(A)/n of the adjacency matrix, the MSN project's connectivity (erratum E8)."""
    from flint import nmod_mat

    n = ensure_count("n", n)
    pairs = ensure_links(pairs, n)
    adjacency = nmod_mat(n, n, _PRIME)
    for i, j in [*pairs.tolist(), *((k, k) for k in range(n - 1) if typeset)]:
        adjacency[i, j] = adjacency[j, i] = 1
    return float(adjacency.rank()) / n
