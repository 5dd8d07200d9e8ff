"""Frozen tree of the minimal model, edge by edge: lengths, energies, equilibria, linearisation."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import sqrt

import numpy as np

from flockana.measures.perception import Edges, edge_vectors, incidence, is_connected, out_tree_root
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.stability import linearise
from flockana.theorems.bounds_between_samples import least_distance
from flockana.theorems.theorem_toolkit import EPS, Enclosure, FloatArray, Hypothesis, Observed, condition, stacked


@dataclass(frozen=True)
class TreeCase:
    """Minimal flocking law on a frozen tree graph, with its quantities for each edge."""

    law: MinimalFlocking
    n: int
    links: Edges
    rho: FloatArray
    mu: FloatArray
    align: FloatArray
    root: int | None

    @property
    def barrier(self) -> FloatArray:
        """Energy ½ μ ρ² for compressing each edge to length 0."""
        return 0.5 * self.mu * self.rho**2

    @cached_property
    def walk(self) -> tuple[tuple[int, int, int], ...]:
        """Edges as (edge, agent nearer to the root, agent farther from it), from the root outwards."""
        visited_agents, outward_edges = {self.links[0][0] if self.root is None else self.root}, []
        left = dict(enumerate(self.links))
        while left:
            for e, (j, i) in list(left.items()):
                if j in visited_agents or i in visited_agents:
                    outward_edges.append((e, j, i) if j in visited_agents else (e, i, j))
                    visited_agents |= {j, i}
                    del left[e]
        return tuple(outward_edges)

    def on_manifold(self, q: FloatArray) -> FloatArray:
        """Return a configuration with the bearings of q and every edge at its desired length."""
        x = edge_vectors(q, self.links)
        distance = np.linalg.norm(x, axis=1, keepdims=True)
        bearing = np.divide(x, distance, out=np.tile(np.eye(q.shape[1])[0], (len(x), 1)), where=distance > 0.0)
        placed: FloatArray = np.zeros_like(x, shape=q.shape)
        for e, near, far in self.walk:
            offset = self.rho[e] * bearing[e]  # from the head of the edge to its tail
            placed[far] = placed[near] - offset if self.links[e] == (near, far) else placed[near] + offset
        return placed

    def edge_system(self, q: FloatArray) -> FloatArray:
        """Return the matrix A of the edge dynamics (x, x') at an equilibrium."""
        m = q.shape[1]
        T = np.kron(-incidence(self.n, self.links).T, np.eye(m))
        doubled_tree = np.kron(np.eye(2), T)
        return doubled_tree @ linearise(self.law, q).A @ np.kron(np.eye(2), np.linalg.pinv(T))

    def lengths(self, q: FloatArray) -> FloatArray:
        """Return ‖x_e‖ of each edge, shape (..., n − 1)."""
        return np.linalg.norm(edge_vectors(q, self.links), axis=-1)

    def edges_of(self, x: FloatArray, error: FloatArray) -> Enclosure:
        """Return enclosures of the length of x_j − x_i over each edge, for vectors with given errors."""
        tails, heads = np.array(self.links, dtype=np.intp).T
        distances = np.linalg.norm(x[..., heads, :] - x[..., tails, :], axis=-1)
        return Enclosure.around(distances, error[..., tails] + error[..., heads] + 4.0 * EPS * distances).clip(0.0)

    def energies(self, lengths: Enclosure, rates: Enclosure) -> Enclosure:
        """Return the energy V = ½‖x'‖² + ½μ(‖x‖ − ρ)² of each edge, from ‖x‖ and ‖x'‖."""
        return 0.5 * (rates.square() + self.mu * (lengths - self.rho).square())

    def shortest(self, seen: Observed) -> Enclosure:
        """Return an enclosure of each edge's least length over a run, between samples too, shape (n − 1,)."""
        return stacked([least_distance(seen, [j], [i]) for j, i in self.links])


def tree_case(law: MinimalFlocking, n: int) -> TreeCase | None:
    """Return the edges of a law on a frozen tree, directed or undirected; None for other graphs."""
    if law.edges is None:
        return None
    root = out_tree_root(n, law.edges)
    links = law.edges if root is not None else tuple((j, i) for j, i in law.edges if j < i)
    if root is None and not (law.reciprocal and len(links) == n - 1 and is_connected(n, links)):
        return None
    edge_indices = [law.edges.index(link) for link in links]
    _, _, mu, rho, align_weights = law.edge_data(np.empty((n, 1)))
    return TreeCase(law, n, links, rho[edge_indices], mu[edge_indices], align_weights[edge_indices], root)


def characteristic_residual(A: FloatArray, factors: Sequence[tuple[float, float]]) -> float:
    """Return the largest relative difference between det(sI − A) and Π (s² + b s + c) over enough points."""
    radius = 4.0 * max(abs(b) + sqrt(abs(c)) for b, c in factors)  # far outside all roots, where nothing cancels
    points = radius * np.exp(2j * np.pi * np.arange(len(A) + 1) / (len(A) + 1))
    determinants = np.array([np.linalg.slogdet(s * np.eye(len(A)) - A) for s in points])
    stated_logs = np.array([np.sum([np.log(s * s + b * s + c) for b, c in factors]) for s in points])
    return float(np.abs(determinants[:, 0] * np.exp(determinants[:, 1] - stated_logs) - 1.0).max())


def minimal_law(seen: Observed) -> Hypothesis:
    """Return the hypothesis that a run is of the minimal law."""
    return condition("the minimal law is applied", type(seen.law) is MinimalFlocking, detail=seen.law.title)


def tree_hypotheses(seen: Observed) -> tuple[list[Hypothesis], TreeCase | None]:
    """Return the hypotheses shared by printed and corrected Theorem 1, and the tree; None without a tree."""
    case, frozen = tree_case(seen.law, seen.n), seen.law.edges is not None
    kind = "no frozen graph" if not frozen else "neither a rooted out-tree nor a reciprocal undirected tree"
    if case is not None:
        kind = "an undirected tree" if case.root is None else f"an out-tree from agent {case.root}, which reaches all"
    requirements = [
        condition("the graph never changes", frozen, detail="" if frozen else "perceived"),
        condition("the graph is a spanning tree", case is not None, detail=kind),
    ]
    if case is not None:
        for name, weights in (("μ > 0", case.mu), ("alignment weights are positive", case.align)):
            smallest = float(weights.min())
            requirements.append(condition(name, smallest > 0.0, smallest))
    return requirements, case
