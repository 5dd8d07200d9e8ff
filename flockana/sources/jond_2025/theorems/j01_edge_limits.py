"""Erratum J1: on a directed tree edges converge to their desired lengths, not to zero as Theorem 1 says."""

import numpy as np

from flockana.measures.nets import components
from flockana.measures.perception import Edges, edge_vectors, random_out_tree
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.theorems.tree_case import TreeCase, tree_case
from flockana.sources.jond_2025.theorems.tree_limits import kept, settles
from flockana.theorems.observed_run import End, Observed, observed
from flockana.theorems.random_start_shares import CONFIDENCE, interval
from flockana.theorems.theorem_toolkit import Claim, Enclosure, FloatArray, Tolerances, erratum, judged, limit_claim

_TREES, _MOST_AGENTS, _SEED, _END = 200, 8, 1, 80.0  # agents of a tree at most; s


def random_forest(count: int, seed: int) -> tuple[MinimalFlocking, FloatArray, FloatArray]:
    """Return (law, q, p) of many independent random out-trees of 2 to 8 agents, simulated in one run."""
    rng = np.random.default_rng(seed)
    edges: list[tuple[int, int]] = []
    agents = 0
    for _ in range(count):
        n = int(rng.integers(2, _MOST_AGENTS + 1))
        edges += [(j + agents, i + agents) for j, i in random_out_tree(n, rng)]
        agents += n
    q, p = rng.uniform(0.0, 4.0, (agents, 2)), rng.uniform(-1.0, 1.0, (agents, 2))
    return MinimalFlocking(edges=tuple(edges), spacing=1.0), q, p


def _trees(seen: Observed) -> list[tuple[TreeCase, End]]:
    """Return the trees of a forest, each with its state at the end of the run."""
    edges: Edges = seen.law.edges
    label = components(seen.n, np.array(edges, dtype=np.int32))
    trees = []
    for k in range(int(label.max()) + 1):
        agents = np.flatnonzero(label == k)
        place = {int(agent): number for number, agent in enumerate(agents)}
        law = MinimalFlocking(
            edges=tuple((place[j], place[i]) for j, i in edges if j in place), spacing=seen.law.spacing
        )
        case = tree_case(law, len(agents))
        assert case is not None
        trees.append((case, End(*(state_array[agents] for state_array in seen.end))))
    return trees


@erratum("J1")
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Theorem 1 says that the edge vectors x and their rates converge to zero. x = 0 is a collision and contradicts the
    goal (27); what converges is the length error | |x_e| - α_i r_i | and the velocity difference.
    """
    law, q, p = random_forest(_TREES, _SEED)
    seen = observed(law, q, p, (0.0, _END), t_eval=(0.0, _END))
    edge_lengths, trees = np.linalg.norm(edge_vectors(seen.end.q, law.edges or ()), axis=1), _trees(seen)
    certificates = [settles(*tree) for tree in trees]
    settled_count, keeping = sum(item.certain for item in certificates), [kept(*tree) for tree in trees]
    vanished, (fewest, maximum) = sum(not kept_ratio > 0.0 for kept_ratio in keeping), interval(settled_count, _TREES)
    case = {"trees": _TREES, "agents": f"2 to {_MOST_AGENTS}", "seed": _SEED, "t": _END}
    return [
        judged("printed", Enclosure.of(-max(keeping)), about="all", disproof="bearing-distance-printed").described(
            computed={"trees whose edges might all vanish": vanished},
            stated="|x_e| -> 0 on every edge of every spanning tree",
            witness=case | {"shortest edge at the end": float(edge_lengths.min())},
            detail=f"of {_TREES} random directed trees {_TREES - vanished} keep an edge longer than 0 permanently; the "
            f"shortest of all is {edge_lengths.min():.8g} αr at the end",
        ),
        limit_claim("corrected", [], [min(certificates, key=lambda certificate: certificate.margin)]).described(
            computed={"trees": settled_count, "interval": [fewest, maximum]},
            stated="what converges is | |x_e| - α_i r_i | and the velocity difference, on every edge",
            witness=case | {"largest length error": float(np.abs(edge_lengths - 1.0).max())},
            detail=f"{settled_count} of {_TREES} random trees tend to edges of length αr and equal velocities; share "
            f"at least {fewest:.3f} ({CONFIDENCE:.0%}, Clopper-Pearson)",
        ),
    ]
