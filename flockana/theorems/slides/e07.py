"""Erratum E7: C* is a share of nodes, though it is printed as a share of edges."""

from __future__ import annotations

import numpy as np

from flockana.measures.metrics import giant_share
from flockana.measures.nets import links, printed_edge_share
from flockana.theorems.claims import erratum, judged
from flockana.theorems.theorem import Claim, Tolerances


def _check(tolerances: Tolerances) -> list[Claim]:
    """The slides' own example: components of 1, 1, 1, 1 and 96 agents."""
    q = np.concatenate([np.arange(96.0), 1000.0 * np.arange(1.0, 5.0)])[:, None]
    printed, true = printed_edge_share(100, links(q, 1.5)), giant_share(q, 1.5)
    return [
        _share("printed", printed, f"as printed, the share of edges in the giant component is {printed:g}, not 0.96"),
        _share("corrected", true, f"the share of nodes is {true:g}, the example's number"),
    ]


def _share(name: str, share: float, detail: str) -> Claim:
    """Whether a share of the hundred agents is the source's: 96 of them, as a whole number."""
    margin = 0.5 - abs(round(100.0 * share) - 96)
    return judged(
        name, margin, 0.0, computed=share, stated=0.96, witness="components of 1, 1, 1, 1 and 96 agents", detail=detail
    )


THEOREM = erratum(
    "E7",
    title="C* is a share of nodes, not of edges",
    statement=(
        "The slides define C* = |E(Γ*)|/|E(G)| and give 0.96 for components of 1, 1, 1, 1, 96 agents. Isolated agents "
        "have no edges, so that formula gives 1; the example counts nodes."
    ),
    source="slides, 'more accurate measure of connectivity'",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
    expected={"printed": "refuted", "corrected": "verified"},
)
