"""Erratum E7: C* is a share of nodes, though it is printed as a share of edges."""

from typing import Any

import numpy as np

from flockana.measures.metrics import connectivity, giant_share
from flockana.measures.nets import links, printed_edge_share
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, by_count, erratum

_PROOF = "net-measures"
_SPACE = 1000.0  # between components; within one, neighbours are 1 apart and the range is 1.5


def _components(*sizes: int) -> FloatArray:
    """Return positions on a line of groups of agents, each connected and out of range of all other groups."""
    rows = [_SPACE * k + np.arange(float(agent_count)) for k, agent_count in enumerate(sizes)]
    return np.concatenate(rows)[:, None]


def _share(name: str, share: float, count: int, of: int, witness: str, detail: str) -> Claim:
    """Return the claim that a computed fraction equals a stated count divided by a total."""
    stated_text = f"{count / of:g}" if of == 100 else f"{count}/{of}"
    proof: dict[str, Any] = {"disproof" if name == "printed" else "proof": _PROOF}
    claim = by_count(name, abs(round(of * share) - count), **proof)
    return claim.described(computed=share, stated=stated_text, witness=witness, detail=detail)


@erratum("E7", expected={"refuted": "printed", "verified": "corrected connectivity-1 connectivity-2 share-2"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The slides define C* = |E(Γ*)|/|E(G)| and give 0.96 for components of 1, 1, 1, 1, 96 agents. Isolated agents have
    no edges, so that formula gives 1; the example counts nodes. C = 95/99 there and for five components of 20 agents,
    where C* = 0.2, as printed.
    """
    # The slides' own examples.
    few, uneven_split = "components of 1, 1, 1, 1 and 96 agents", _components(1, 1, 1, 1, 96)
    wording, even = "five components of 20 agents", _components(20, 20, 20, 20, 20)
    ranks = {few: connectivity(uneven_split, 1.5), wording: connectivity(even, 1.5)}  # which cannot tell the two apart
    printed, true_value = printed_edge_share(100, links(uneven_split, 1.5)), giant_share(uneven_split, 1.5)
    nodes, edges = giant_share(even, 1.5), printed_edge_share(100, links(even, 1.5))
    formula_text = f"by the printed formula, the share of edges in the giant component, C* is {printed:g}, not 0.96"
    text = f"C* = {nodes:g}; the share of edges, {edges:g}, is the same here, as all components are alike"
    five = "five components, whatever their sizes"
    return [
        _share("printed", printed, 96, 100, few, formula_text),
        _share("corrected", true_value, 96, 100, few, f"the share of nodes is {true_value:g}, the example's number"),
        *(
            _share(f"connectivity-{k}", C, 95, 99, net_name, f"C = {round(99.0 * C)}/99 for {net_name}: {five}")
            for k, (net_name, C) in enumerate(ranks.items(), 1)
        ),
        _share("share-2", nodes, 20, 100, wording, text),
    ]
