"""Erratum J19: by the printed definition a tree's root is globally reachable from nowhere, a star is disconnected."""

from itertools import product
from typing import Any

from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, exact

_NODES = 5


def out_trees(n: int, root: int = 0) -> list[Any]:
    """Return all directed trees on n labelled nodes whose edges (j, i), from j to i, lead away from a root."""
    import networkx

    trees = map(networkx.from_prufer_sequence, product(range(n), repeat=n - 2))
    return [networkx.bfs_tree(tree, root) for tree in trees]


def globally_reachable(graph: Any) -> set[int]:
    """Return the nodes to which a sequence of edges leads from every other node: the printed definition."""
    import networkx

    return {i for i in graph if len(networkx.ancestors(graph, i)) == len(graph) - 1}


@erratum("J19", expected={"refuted": "root star", "verified": "corrected"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """An edge (j, i) leads from j to i, and node i is called globally reachable if edges lead to it from all others,
    which is to be the root of a spanning tree; a graph is connected if it has such a node. In a tree that leads away
    from its root the root is reached from nowhere. Right is that edges lead from the root to all others.
    """
    trees = out_trees(_NODES)
    root_sets = [globally_reachable(tree) for tree in trees]
    roots, reachable_count = sum(0 in nodes for nodes in root_sets), sum(map(bool, root_sets))
    star = next(tree for tree in trees if tree.out_degree(0) == _NODES - 1)
    rooted_count = sum(globally_reachable(tree.reverse()) == {0} for tree in trees)
    return [
        exact("root", roots == len(trees), computed=roots).described(
            stated=f"the root of each of the {len(trees)} trees on {_NODES} nodes is globally reachable",
            detail=f"the root is globally reachable in {roots} of {len(trees)}",
        ),
        exact("star", reachable_count == len(trees), computed=reachable_count).described(
            stated="a graph with a spanning tree is connected as defined",
            witness=sorted(star.edges),
            detail=f"{reachable_count} of {len(trees)} have a globally reachable node: the paths; a star has none",
        ),
        exact("corrected", rooted_count == len(trees), computed=rooted_count).described(
            stated="from the root edges lead to every other node",
            detail=f"so it is in all {len(trees)}, and from no other node",
        ),
    ]
