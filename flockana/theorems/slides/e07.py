"""Erratum E7: C* is a share of nodes, though it is printed as a share of edges."""

from typing import Any

import numpy as np

from flockana.measures.metrics import connectivity, giant_share
from flockana.measures.nets import links, printed_edge_share
from flockana.theorems.toolkit import Claim, FloatArray, Tolerances, by_count, erratum

_PROOF = "net-measures"
_SPACE = 1000.0  # between components; within one, neighbours are 1 apart and the range is 1.5


def _components(*sizes: int) -> FloatArray:
    """Rows of agents, each within range of the next, the rows out of range of each other."""
    rows = [_SPACE * k + np.arange(float(size)) for k, size in enumerate(sizes)]
    return np.concatenate(rows)[:, None]


def _share(name: str, share: float, witness: str, detail: str, *, stated: int = 96) -> Claim:
    """Return the claim that a share of the hundred agents is the source's, as a whole number."""
    return _number(name, share, 100, stated, f"{stated / 100.0:g}", witness, detail)


def _relative(name: str, share: float, witness: str) -> Claim:
    """Return the claim that C is 95/99: both nets have five components, and C cannot tell them apart."""
    detail = f"C = {round(99.0 * share)}/99 for {witness}: five components, whatever their sizes"
    return _number(name, share, 99, 95, "95/99", witness, detail)


def _number(name: str, share: float, of: int, count: int, stated: str, witness: str, detail: str) -> Claim:
    """Return the claim that a share is a given number of a total."""
    proof: dict[str, Any] = {"disproof" if name == "printed" else "proof": _PROOF}
    off = abs(round(of * share) - count)
    return by_count(name, off, computed=share, stated=stated, witness=witness, detail=detail, **proof)


@erratum(
    "E7",
    source="slides, 'more accurate measure of connectivity'",
    references=("geschwender-2016", "olfati-saber-2006"),
    expected={"refuted": "printed", "verified": "corrected connectivity-1 connectivity-2 share-2"},
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The slides define C* = |E(Γ*)|/|E(G)| and give 0.96 for components of 1, 1, 1, 1, 96 agents. Isolated agents have
    no edges, so that formula gives 1; the example counts nodes. C = 95/99 there and for five components of 20 agents,
    where C* = 0.2, as printed.
    """
    # The slides' own examples: components of 1, 1, 1, 1 and 96 agents, and five of 20 each.
    uneven, even = _components(1, 1, 1, 1, 96), _components(20, 20, 20, 20, 20)
    printed, true = printed_edge_share(100, links(uneven, 1.5)), giant_share(uneven, 1.5)
    few, both = "components of 1, 1, 1, 1 and 96 agents", "five components of 20 agents"
    nodes, edges = giant_share(even, 1.5), printed_edge_share(100, links(even, 1.5))
    text = f"C* = {nodes:g}; the share of edges, {edges:g}, is the same here, as all components are alike"
    return [
        _share(
            "printed",
            printed,
            few,
            f"by the printed formula, the share of edges in the giant component, C* is {printed:g}, not 0.96",
        ),
        _share("corrected", true, few, f"the share of nodes is {true:g}, the example's number"),
        _relative("connectivity-1", connectivity(uneven, 1.5), few),
        _relative("connectivity-2", connectivity(even, 1.5), both),
        _share("share-2", nodes, both, text, stated=20),
    ]
