"""Frozen undirected trees of the bearing-distance law: ranks of D and of the rigidity matrix, for every n."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.sources.jond_2025.symbolic.spanning_trees import incidence_matrix
from proofs.proof import Step
from proofs.rooted_trees import Tree, trees, unit_edge
from proofs.smt import implication


def leaf_row(text: str, d: int, *, length: int = 1) -> Step:
    """The step of the induction that a leaf's row is independent of the others, whose entries in its columns are 0.

    A combination of rows that vanishes has λ x̂ = 0 there, λ of the leaf's row: so λ = 0, and the rest is one of the
    tree without the leaf.
    """
    weight, *direction = z3.Reals("λ " + " ".join(f"x_{k}" for k in range(1, d + 1)))
    return implication(
        text,
        weight == 0,
        z3.Sum([x * x for x in direction]) == length,
        *(weight * x == 0 for x in direction),
        latex=r"\operatorname{rank}\begin{pmatrix} R & 0 \\ a & \hat x^\top\end{pmatrix} = \operatorname{rank} R + 1",
    )


def undirected_trees() -> Iterator[Step]:
    """All springs of a tree at rest are slack, and what else does not change its energy."""
    yield leaf_row("undirected, every n: a leaf's entry in D is ±1, and its row is independent: D has rank n - 1", 1)
    for d in (2, 3):
        yield leaf_row(
            f"undirected, d = {d}, every n: so is the row of a leaf's direction: rank n - 1, dn - (n - 1) zero modes", d
        )
    yield Step(
        "undirected: with all v equal, all u are 0; then a leaf's one spring is slack, and so are all of a tree",
        all(incidence_matrix(edges).rank() == agents - 1 for agents in range(2, 7) for edges in trees(agents)),
        r"\sum_e D_{ie}\, g(x_e) = 0 \text{ for all } i \implies g(x_e) = 0 \implies |x_e| = \rho",
        "D has rank n - 1: for every n by the induction, and computed for all trees of 2 to 6 agents",
    )
    for d in (2, 3):
        yield Step(
            f"undirected, d = {d}: then (n - 1)(d - 1) zero modes besides translations: each leaf adds one row",
            all(_zero_modes(edges, d) == agents * (d - 1) + 1 for agents in range(2, 6) for edges in trees(agents)),
            r"\dim\ker \sum_e \mu_e\, \hat x_e \hat x_e^\top = d + (n - 1)(d - 1)",
            "for every n by the induction, and computed for all trees of 2 to 5 agents, in rational directions",
        )


def _zero_modes(edges: Tree, d: int) -> int:
    """Of the Hessian Σ μ x̂x̂ᵀ at edges of length ρ: the kernel of the rows x̂ᵀ of the rigidity matrix."""
    matrix = incidence_matrix(edges)
    rows = [sp.kronecker_product(matrix[:, e].T, unit_edge(e, d).T) for e in range(len(edges))]
    return int(matrix.rows * d - sp.Matrix.vstack(*rows).rank())
