"""Errata E7 and E8: which share of a net is counted, and by the rank of which matrix."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication

UNEVEN, EVEN = (1, 1, 1, 1, 96), (20, 20, 20, 20, 20)  # the slides' components
STATED = {"nodes": "24/25", "connectivity": "95/99"}


def share_of_links(sizes: tuple[int, ...]) -> sp.Expr:
    """Links in the largest component over all links, for any number of links in each that can have one."""
    links = [sp.Symbol(f"L_{k}", positive=True) if size > 1 else sp.S.Zero for k, size in enumerate(sizes)]
    return sp.cancel(links[sizes.index(max(sizes))] / sum(links))


def share_of_nodes(sizes: tuple[int, ...]) -> Fraction:
    """Agents in the largest component over all agents."""
    return Fraction(max(sizes), sum(sizes))


def connectivity(sizes: tuple[int, ...]) -> Fraction:
    """rank L/(n - 1), as the rank is the number of agents less that of components."""
    return Fraction(sum(sizes) - len(sizes), sum(sizes) - 1)


def path_matrices() -> tuple[sp.Matrix, sp.Matrix]:
    """(A, L) of a path of three agents."""
    adjacency = sp.Matrix([[0, 1, 0], [1, 0, 1], [0, 1, 0]])
    return adjacency, sp.diag(*(adjacency * sp.ones(3, 1))) - adjacency


def _shares() -> Iterator[Step]:
    yield Step(
        "components of 1, 1, 1, 1 and 96 agents: an agent alone has no link, so that the share of links is 1, however "
        "many there are; the share of nodes is 96/100, the slides' number",
        share_of_links(UNEVEN) == 1 and share_of_nodes(UNEVEN) == Fraction(96, 100),
        found={"nodes": str(share_of_nodes(UNEVEN))},
    )
    yield Step("five components of 20: the share of nodes is 1/5", share_of_nodes(EVEN) == Fraction(1, 5))


def _ranks() -> Iterator[Step]:
    x, y, rest = z3.Reals("x y rest")
    yield implication(
        "xᵀLx = Σ (x_i - x_j)² over the links: where it vanishes, x is equal across each link (the others count >= 0), "
        "so that Lx = 0 exactly if x is constant on components, and rank L = n - number of components",
        x == y,
        *(rest >= 0, (x - y) * (x - y) + rest == 0),
    )
    i, j, edge = sp.symbols("x_i x_j"), sp.symbols("y_1:3"), sp.Matrix([1, -1])
    yield Step(
        "of one link xᵀ(bbᵀ)x = (x_i - x_j)², b = e_i - e_j, and L is the sum of these",
        sp.expand((sp.Matrix([i]) * edge)[0] ** 2 - (i[0] - i[1]) ** 2) == 0
        and sp.expand((sp.Matrix([j]) * (edge * edge.T) * sp.Matrix([j]).T)[0] - (j[0] - j[1]) ** 2) == 0,
    )
    yield Step(
        "five components of 100 agents, whatever their sizes: rank L/(n - 1) = 95/99",
        connectivity(UNEVEN) == connectivity(EVEN) == Fraction(95, 99),
        found={"connectivity": str(connectivity(UNEVEN))},
    )
    adjacency, laplacian = path_matrices()
    yield Step(
        "a path of three agents is connected: rank A/n = 2/3, rank L/(n - 1) = 1",
        adjacency.rank() == 2 and adjacency.det() == 0 and laplacian.rank() == 2,
        r"\det A = 0",
    )


def _steps() -> Iterator[Step]:
    yield from _shares()
    yield from _ranks()


PROOF = Proof(
    id="net-measures",
    title="Errata E7 and E8: what C* and C count",
    statement=(
        f"Of components of {', '.join(map(str, UNEVEN))} agents the largest has all links, and {STATED['nodes']} of "
        f"the nodes; rank L/(n - 1) is {STATED['connectivity']} there, and for any {len(UNEVEN)} components of as many "
        "agents. On a path of three agents rank A/n = 2/3, rank L/(n - 1) = 1."
    ),
    hypotheses="undirected nets",
    rigour="smt",
    steps=_steps,
    size=6,
    theorems=("E7", "E8"),
    values=STATED,
)
