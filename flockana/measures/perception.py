"""Directed perception graphs, where an edge (j, i) means that i perceives j: trees and matrices."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.measures.nets import components

Edges = tuple[tuple[int, int], ...]


def ensure_edges(edges: Any) -> Edges:
    """Return directed edges (j, i) as a tuple of pairs."""
    pairs = _pairs("edges", edges, "expected each edge once; for both directions give (j, i), (i, j)")
    if not pairs:
        raise ArgumentError(f"edges = {edges!r}: expected pairs (j, i), such as ((0, 1), (1, 2)): 1 perceives 0")
    return pairs


def ensure_net(name: str, links: Any) -> Edges:
    """Return undirected links (i, j) with i < j, sorted."""
    return tuple(sorted(_pairs(name, links, "expected each link once", directed=False)))


def ensure_in_flock(name: str, pairs: Edges, n: int) -> None:
    """Raise if pairs name an agent outside a flock of n agents."""
    if (last := max(map(max, pairs), default=0)) >= n:
        raise ArgumentError(f"{name} name agent {last} but there are {n} agents: expected numbers 0 to {n - 1}")


def _pairs(name: str, given: Any, once: str, *, directed: bool = True) -> Edges:
    """Return pairs of different agents in the given order, smaller index first unless directed."""
    unique: dict[tuple[int, int], None] = {}
    if not isinstance(given, Iterable):
        raise ArgumentError(f"{name} = {given!r}: expected pairs of agents such as ((0, 1), (1, 2))")
    for k, edge in enumerate(given):
        pair = np.asarray(edge)
        if pair.shape != (2,) or pair.dtype.kind not in "iu" or pair.min() < 0 or pair[0] == pair[1]:
            raise ArgumentError(f"{name}[{k}] = {edge!r}: expected two different agents, counted from 0")
        i, j = map(int, pair if directed else np.sort(pair))
        if (i, j) in unique:
            raise ArgumentError(f"{name}[{k}] = {(i, j)}: {once}")
        unique[i, j] = None
    return tuple(unique)


def both_ways(links: Iterable[tuple[int, int]]) -> Edges:
    """Return the directed edges of an undirected graph: each link in both directions."""
    return ensure_edges([pair for i, j in links for pair in ((i, j), (j, i))])


def random_out_tree(n: int, rng: np.random.Generator) -> Edges:
    """Return a random rooted out-tree: agent 0 is the root, and each other agent perceives an earlier one."""
    return ensure_edges([(int(rng.integers(i)), i) for i in range(1, n)])


def out_tree_root(n: int, edges: Edges) -> int | None:
    """Return the root of a rooted out-tree, or None for any other graph."""
    # Information flows along edges, so the root perceives nobody and all others are reached from it. (The paper calls
    # "root" a node that all others reach: against its own direction of edges that would be the opposite tree.)
    in_degrees = np.bincount([i for _, i in edges], minlength=n)
    if len(edges) != n - 1 or in_degrees.max() > 1 or not is_connected(n, edges):
        return None  # n − 1 edges, each to another agent, connected: no room for a cycle
    return int(np.argmin(in_degrees))


def is_connected(n: int, edges: Edges) -> bool:
    """Return whether the graph is weakly connected."""
    return int(components(n, np.array(edges, dtype=np.int32).reshape(-1, 2)).max()) == 0


def incidence(n: int, edges: Edges) -> FloatArray:
    """Return the incidence matrix D, shape (n, M): +1 where an agent receives along an edge, −1 where it sends."""
    D, index = np.zeros((n, len(edges))), np.arange(len(edges))
    sender, receiver = np.array(edges).T
    D[receiver, index], D[sender, index] = 1.0, -1.0
    return D


def receivers(n: int, edges: Edges) -> FloatArray:
    """Return D_in, shape (n, M): the incidence matrix with receivers' entries only."""
    return np.maximum(incidence(n, edges), 0.0)


def edge_vectors(q: FloatArray, edges: Edges) -> FloatArray:
    """Return x_e = q_j − q_i of each edge (j, i), shape (..., M, m)."""
    sender, receiver = np.array(edges).T
    return q[..., sender, :] - q[..., receiver, :]
