"""Erratum J5: agents with different numbers of neighbours want two lengths of one edge, and the flock runs away."""

from __future__ import annotations

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.laws.minimal import MinimalFlocking
from flockana.measures.perception import both_ways, incidence
from flockana.theorems.claims import erratum, of_state
from flockana.theorems.limits import Certificate, limit_claim
from flockana.theorems.theorem import Claim, Tolerances

_STARTS, _END = 20, 60.0
_INTEGRATED = 1e-8  # of a run at the default tolerances that has settled
_PROOF = "bearing-distance-printed"


def _end(law: MinimalFlocking, seed: int) -> FloatArray:
    """(distance of the ends, both edges, all three |u|) at t = 60, from a random start."""
    rng = np.random.default_rng(seed)
    q, p = rng.uniform(-2.0, 2.0, (3, 2)), rng.uniform(-1.0, 1.0, (3, 2))
    run = simulate(law, q, p, (0.0, _END), t_eval=(_END,))
    edges = run.q[-1, [0, 2]] - run.q[-1, 1]
    apart, lengths = np.linalg.norm(edges[0] - edges[1]), np.linalg.norm(edges, axis=1)
    measured: FloatArray = np.array([apart, *lengths, *np.linalg.norm(run.u[-1], axis=1)])
    return measured


def _runaway_attracts(law: MinimalFlocking, worst: float, tolerances: Tolerances) -> Certificate:
    """Certificate that the runaway attracts: runs end near it, where all modes decay but that of its direction."""
    q = np.array([[-5.0 / 3.0, 0.0], [0.0, 0.0], [-5.0 / 3.0, 0.0]])
    T = np.kron(np.eye(2), np.kron(-incidence(3, ((0, 1), (1, 2))).T, np.eye(2)))  # (q, p) to edges and their rates
    modes = np.linalg.eigvals(T @ np.asarray(law.jacobian(0.0, q, 0.0 * q)) @ np.linalg.pinv(T))
    slowest = -float(np.sort(modes.real)[-2])  # the last is 0: it may point anywhere
    text = f"they end within {worst:.1g} of it, and it attracts at a rate of {slowest:.3g} or more"
    return Certificate(min(1.0 - worst / tolerances.lattice, slowest), text, _INTEGRATED / tolerances.lattice)


def _check(tolerances: Tolerances) -> list[Claim]:
    """The ends of an undirected path of three want their edges at length 1, the middle at 2: both become 5/3."""
    law = MinimalFlocking(edges=both_ways([(0, 1), (1, 2)]))
    ends = np.array([_end(law, seed) for seed in range(_STARTS)])
    attracted = _runaway_attracts(
        law, float(np.abs(ends - np.array([0.0, *[5.0 / 3.0] * 2, *[2.0 / 3.0] * 3])).max()), tolerances
    )
    off = float(np.abs(ends[:, 1:3] - 1.0).min())
    return [
        of_state(
            "printed",
            -min(off, attracted.margin),
            attracted.error,
            about="all",
            refutes=attracted.margin > 0.0,
            computed={"edges": float(ends[:, 1:3].mean()), "wanted by the ends": 1.0, "wanted by the middle": 2.0},
            stated="| |x_e| - α_i r_i | -> 0 for all agents, with α_i r_i = |N_i|",
            witness={"graph": "frozen undirected path of three", "seeds": _STARTS},
            proof=_PROOF,
            detail="an edge between agents of different degree is wanted at two lengths at once; it ends at neither",
        ),
        limit_claim(
            "runaway",
            [],
            [attracted],
            computed={
                "ends apart": float(ends[:, 0].max()),
                "edges": float(ends[:, 1:3].mean()),
                "acceleration": float(ends[:, 3:].mean()),
            },
            stated="ends together, 5/3 behind the middle, all with the acceleration 2/3",
            witness={"starts": _STARTS, "t": _END},
            proof=_PROOF,
            detail=f"from {_STARTS} of {_STARTS} starts the ends come to coincide 5/3 behind the middle, and all "
            "accelerate by 2/3 for ever",
        ),
    ]


THEOREM = erratum(
    "J5",
    title="A spacing of |N_i| cannot be had on a spanning tree",
    statement=(
        "With α_i r_i = |N_i| neighbours of different degree want different lengths of their edge, and with equal "
        "radii perception is mutual, so that no graph is a directed tree. On a frozen path of three the ends come "
        "to coincide 5/3 behind the middle, and all accelerate by 2/3 for ever."
    ),
    source="Jond, bearing-distance flocking, section 4, assumptions",
    check=_check,
    references=("jond-2025",),
    expected={"printed": "refuted", "runaway": "verified"},
)
