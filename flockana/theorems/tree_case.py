"""A run of the minimal model on a frozen tree, seen by its edges: what both readings of Theorem 1 need."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from flockana.checks import FloatArray
from flockana.laws.minimal import MinimalFlocking
from flockana.laws.perception import Edges, edge_vectors, incidence, is_connected, out_tree_root
from flockana.stability import linearise
from flockana.theorems.theorem import Hypothesis
from flockana.trajectory import Trajectory


@dataclass(frozen=True)
class TreeCase:
    """A run on a frozen tree, by its edges.

    Parameters
    ----------
    law : MinimalFlocking
        The law.
    n : int
        Number of agents.
    links : tuple of (int, int)
        Its n − 1 edges; of an undirected tree, each link in one direction.
    rho, mu, align : ndarray, shape (n - 1,)
        Desired length, weight of the spring, weight of the velocity difference, of each.
    root : int or None
        The root of a directed tree.
    """

    law: MinimalFlocking
    n: int
    links: Edges
    rho: FloatArray
    mu: FloatArray
    align: FloatArray
    root: int | None

    def on_manifold(self, q: FloatArray) -> FloatArray:
        """The configuration with the bearings of q and every edge at its desired length; bearings are free.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions, no edge of length 0.
        """
        x = edge_vectors(q, self.links)
        x = x * (self.rho / np.linalg.norm(x, axis=1))[:, None]
        placed: FloatArray = np.linalg.pinv(-incidence(self.n, self.links).T) @ x
        return placed

    def edge_system(self, q: FloatArray) -> FloatArray:
        """A of the edge dynamics (x, x') at an equilibrium: T A T⁺ with T = −Dᵀ ⊗ I, since u depends on edges alone.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        m = q.shape[1]
        T = np.kron(-incidence(self.n, self.links).T, np.eye(m))
        twice = np.kron(np.eye(2), T)
        A: FloatArray = twice @ linearise(self.law, q).A @ np.kron(np.eye(2), np.linalg.pinv(T))
        return A


def tree_case(law: MinimalFlocking, n: int) -> TreeCase | None:
    """The edges of a law on a frozen tree, directed from a root or undirected; None if its graph is no tree.

    Parameters
    ----------
    law : MinimalFlocking
        The law.
    n : int
        Number of agents.
    """
    if law.edges is None:
        return None
    root = out_tree_root(n, law.edges)
    links = law.edges if root is not None else tuple((j, i) for j, i in law.edges if j < i)
    if root is None and not (law.reciprocal and len(links) == n - 1 and is_connected(n, links)):
        return None
    where = [law.edges.index(link) for link in links]
    _, _, mu, rho, align = law.edge_data(np.empty((n, 1)))
    return TreeCase(law, n, links, rho[where], mu[where], align[where], root)


def characteristic_residual(A: FloatArray, factors: Sequence[tuple[float, float]]) -> float:
    """Largest relative difference between det(sI − A) and Π (s² + b s + c), at as many points as decide a polynomial.

    Parameters
    ----------
    A : ndarray, shape (2k, 2k)
        A matrix.
    factors : sequence of k pairs (b, c)
        Quadratic factors.

    Examples
    --------
    >>> characteristic_residual(np.array([[0.0, 1.0], [-2.0, -3.0]]), [(3.0, 2.0)]) < 1e-12
    True
    """
    radius = 1.0 + max(abs(b) + sqrt(abs(c)) for b, c in factors)  # outside all roots, where nothing cancels
    points = radius * np.exp(2j * np.pi * np.arange(len(A) + 1) / (len(A) + 1))
    found = np.array([np.linalg.slogdet(s * np.eye(len(A)) - A) for s in points])
    stated = np.array([np.sum([np.log(s * s + b * s + c) for b, c in factors]) for s in points])
    return float(np.abs(found[:, 0] * np.exp(found[:, 1] - stated) - 1.0).max())


def tree_hypotheses(run: Trajectory) -> tuple[list[Hypothesis], TreeCase | None]:
    """Hypotheses that both readings of the theorem share, and the tree if there is one.

    Parameters
    ----------
    run : Trajectory
        The run.
    """
    applies = type(run.law) is MinimalFlocking
    needs = [Hypothesis("the minimal law is applied", "met" if applies else "unmet", detail=type(run.law).__name__)]
    if not applies:
        return needs, None
    law, case = run.law, tree_case(run.law, run.n)
    frozen = law.edges is not None
    kind = "no frozen graph" if not frozen else "neither a rooted out-tree nor a reciprocal undirected tree"
    if case is not None:
        kind = "an undirected tree" if case.root is None else f"an out-tree from agent {case.root}, which reaches all"
    needs += [
        Hypothesis("the graph never changes", "met" if frozen else "unmet", detail="" if frozen else "perceived"),
        Hypothesis("the graph is a spanning tree", "met" if case else "unmet", detail=kind),
    ]
    return needs, case


def root_edges(case: TreeCase, q: FloatArray, p: FloatArray) -> dict[int, tuple[float, float]]:
    """For each edge from the root, (V, least length that V allows from now on, negative if none).

    V = ½‖x'‖² + ½μ(‖x‖ − ρ)² falls, since nobody moves the root: V' = −a‖x'‖².

    Parameters
    ----------
    case : TreeCase
        The tree.
    q, p : ndarray, shape (n, m)
        A state.
    """
    x, rate = (edge_vectors(state, case.links) for state in (q, p))
    V = 0.5 * (np.sum(rate * rate, axis=1) + case.mu * (np.linalg.norm(x, axis=1) - case.rho) ** 2)
    return {
        e: (float(V[e]), float(case.rho[e] - sqrt(2.0 * V[e] / case.mu[e])))
        for e, (j, _) in enumerate(case.links)
        if j == case.root
    }
