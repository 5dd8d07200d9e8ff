"""Erratum E8: connectivity is the rank of the Laplacian, not of the adjacency matrix."""

from typing import Any

from flockana.measures.metrics import connectivity
from flockana.measures.nets import links, printed_rank_connectivity
from flockana.theorems.theorem_toolkit import Claim, Tolerances, by_count, erratum

_PROOF = "net-measures"


def _rank(name: str, share: float, full: int, detail: str, **proof: Any) -> Claim:
    """Return the claim that a connectivity measure is 1 on a connected path of three agents, by integer rank."""
    return by_count(name, full - round(full * share), **proof).described(
        computed=share, stated=1.0, witness="a path of three agents", detail=detail
    )


@erratum("E8")
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The MSN project measures connectivity by C = rank(A)/n of the adjacency matrix, to be 1 on a connected net. A
    path of three agents is connected and gives 2/3; C = rank(L)/(n - 1) gives 1.
    """
    # A path of three agents: connected, so C must be 1.
    q = [[0.0], [1.0], [2.0]]
    printed_value, true_value = printed_rank_connectivity(3, links(q, 1.5)), connectivity(q, 1.5)
    return [
        _rank("printed", printed_value, 3, f"rank(A)/n is {printed_value:.4g} on a connected path", disproof=_PROOF),
        _rank("corrected", true_value, 2, f"rank(L)/(n - 1) of the Laplacian is {true_value:.4g}", proof=_PROOF),
    ]
