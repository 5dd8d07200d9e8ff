"""Errata J4 to J6: signs, incompatible spacings, and the corrected Theorem 1 of the bearing-distance paper."""

from __future__ import annotations

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.laws.minimal import MinimalFlocking
from flockana.measures.perception import both_ways, edge_vectors, incidence, receivers
from flockana.theorems.bearing_distance import zone_1_corrected
from flockana.theorems.limits import Certificate, limit_claim
from flockana.theorems.second_run import corroborated
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, Verdict, judge

_SOURCE = "Jond, bearing-distance flocking, section 4"
_REFERENCES = ("jond-2025",)
_TREE = ((0, 1), (1, 2), (1, 3), (0, 4))
_STARTS, _END = 20, 60.0
_SAME, _ROUNDING = 1e-9, 1e-13  # relative: forces that differ by less are the same; their rounding
_INTEGRATED = 1e-8  # of a run at the default tolerances that has settled
_PROOF, _PRINTED = "bearing-distance", "bearing-distance-printed"


def _identity(name: str, stated: str, detail: str) -> Claim:
    from flockana.symbolic.spanning_trees import separation_forms

    form = separation_forms(_TREE)[name]
    return Claim(
        name,
        "verified" if form.holds else "refuted",
        "symbolic",
        computed="residual 0" if form.holds else "a residual that is not 0",
        stated=stated,
        witness=[str(row) for row in form.residuals],
        proof=_PRINTED,
        detail=detail,
    )


def _loop() -> Claim:
    """(35) by its matrices against the law itself, and what L = D Dᵀ would have been in its place."""
    rng = np.random.default_rng(0)
    q, p = rng.uniform(-3.0, 3.0, (5, 2)), rng.uniform(-1.0, 1.0, (5, 2))
    law = MinimalFlocking(edges=_TREE, spacing=1.3, mu=0.7)
    D, D_in = incidence(5, _TREE), receivers(5, _TREE)
    w = 0.7 * (1.0 - 1.3 / np.linalg.norm(edge_vectors(q, _TREE), axis=1))
    u = law.acceleration(0.0, q, p)
    error, other = (
        float(np.abs(-left * w @ D.T @ q - left @ D.T @ p - u).max()) for left in (D_in, D)
    )  # W^a = I on a tree
    margin = _SAME - error / float(np.abs(u).max())
    return Claim(
        "loop",
        judge(margin, _ROUNDING, []),
        computed=error,
        stated="u = -D_in W^s Dᵀ p - D_in W^a Dᵀ v, with D_in where the text says 'like the incidence matrix'",
        margin=margin,
        error=_ROUNDING,
        witness={"with D in place of D_in": other},
        detail=f"(35) with D_in agrees with the law to {error:.1g}; with D, as L = D Dᵀ would have it, it is off by "
        f"{other:.3g}",
    )


def _j4(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    return [], [
        _identity("28", "separation = -(d W Dᵀ) p + (d W) q", "(28) as printed has the wrong sign before q"),
        _identity("identity", "(d W) q = α r (d W W^q Dᵀ) p", "so has the identity before (34)"),
        _identity("34", "separation = -(d W (I - α r W^q) Dᵀ) p", "the two errors cancel: (34) is right"),
        _loop(),
    ]


def _three_path(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    """Three agents on an undirected path, each wanting as many units of spacing as it has neighbours."""
    law = MinimalFlocking(edges=both_ways([(0, 1), (1, 2)]))
    last = np.array([_end(law, seed) for seed in range(_STARTS)])
    reached = _reached(law, float(np.abs(last - np.array([0.0, *[5.0 / 3.0] * 2, *[2.0 / 3.0] * 3])).max()), tolerances)
    off = float(np.abs(last[:, 1:3] - 1.0).min())  # the ends want 1, the middle 2, and both edges become 5/3
    margin = -min(off, reached.margin)
    return [], [
        Claim(
            "printed",
            judge(margin, reached.error, []) if reached.margin > 0.0 else "inconclusive",
            computed={"edges": float(last[:, 1:3].mean()), "wanted by the ends": 1.0, "wanted by the middle": 2.0},
            stated="| |x_e| - α_i r_i | -> 0 for all agents, with α_i r_i = |N_i|",
            margin=margin,
            error=reached.error,
            witness={"graph": "frozen undirected path of three", "seeds": _STARTS},
            proof=_PRINTED,
            detail="an edge between agents of different degree is wanted at two lengths at once; it ends at neither",
        ),
        limit_claim(
            "runaway",
            [],
            [reached],
            computed={
                "ends apart": float(last[:, 0].max()),
                "edges": float(last[:, 1:3].mean()),
                "acceleration": float(last[:, 3:].mean()),
            },
            stated="ends together, 5/3 behind the middle, all with the acceleration 2/3",
            witness={"starts": _STARTS, "t": _END},
            proof=_PRINTED,
            detail=f"from {_STARTS} of {_STARTS} starts the ends come to coincide 5/3 behind the middle, and all "
            "accelerate by 2/3 for ever",
        ),
    ]


def _end(law: MinimalFlocking, seed: int) -> FloatArray:
    """(distance of the ends, both edges, all three |u|) at t = 60, from a random start."""
    rng = np.random.default_rng(seed)
    q, p = rng.uniform(-2.0, 2.0, (3, 2)), rng.uniform(-1.0, 1.0, (3, 2))
    run = simulate(law, q, p, (0.0, _END), t_eval=(_END,))
    edges = run.q[-1, [0, 2]] - run.q[-1, 1]
    apart, lengths = np.linalg.norm(edges[0] - edges[1]), np.linalg.norm(edges, axis=1)
    found: FloatArray = np.array([apart, *lengths, *np.linalg.norm(run.u[-1], axis=1)])
    return found


def _reached(law: MinimalFlocking, worst: float, tolerances: Tolerances) -> Certificate:
    """All starts end next to the runaway, which attracts: linearised there every mode decays but for its direction."""
    q = np.array([[-5.0 / 3.0, 0.0], [0.0, 0.0], [-5.0 / 3.0, 0.0]])
    T = np.kron(np.eye(2), np.kron(-incidence(3, ((0, 1), (1, 2))).T, np.eye(2)))  # (q, p) to edges and their rates
    modes = np.linalg.eigvals(T @ np.asarray(law.jacobian(0.0, q, 0.0 * q)) @ np.linalg.pinv(T))
    slowest = -float(np.sort(modes.real)[-2])  # the last is 0: it may point anywhere
    text = f"they end within {worst:.1g} of it, and it attracts at a rate of {slowest:.3g} or more"
    return Certificate(min(1.0 - worst / tolerances.lattice, slowest), text, _INTEGRATED / tolerances.lattice)


def _corrected(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    """The corrected theorem on a directed tree and on an undirected path, in the plane and in space."""
    directed = MinimalFlocking(edges=_TREE, spacing=(1.0, 1.5, 2.0, 1.0, 1.2), mu=2.0)
    undirected = MinimalFlocking(edges=both_ways(_TREE), spacing=1.5, normalised=False)
    claims = []
    for name, law in (("directed", directed), ("undirected", undirected)):
        for m in (2, 3):
            rng = np.random.default_rng(m)
            q, p = rng.uniform(-2.0, 2.0, (5, m)), rng.uniform(-0.5, 0.5, (5, m))
            run = simulate(law, q, p, (0.0, 80.0))
            hypotheses, parts = zone_1_corrected.THEOREM.check(run, tolerances)
            parts = corroborated(tuple(parts), run, lambda again: zone_1_corrected.THEOREM.check(again, tolerances)[1])
            found = Verdict("zone-1-corrected", tuple(hypotheses), parts)
            spectrum = found.claim("spectrum").computed or {}
            claims.append(
                Claim(
                    f"{name}-{m}",
                    found.status,
                    computed={claim.name: claim.status for claim in found.claims},
                    stated=f"every claim of zone-1-corrected, with {4 * (m - 1)} zero modes",
                    witness={"edges": _TREE, "q(0)": q.tolist(), "p(0)": p.tolist()},
                    proof=_PROOF,
                    detail=f"{name} tree of five in {m} dimensions: {found.claim('lengths').detail}; "
                    f"{spectrum.get('zero modes', 'no')} zero modes",
                )
            )
    return [], claims


THEOREM = (
    Theorem(
        id="J4",
        title="Two signs that cancel, and the wrong Laplacian",
        statement=(
            "(28) adds q where it must be subtracted, and the identity before (34) has the sign of q wrong as well: "
            "together they cancel, and (34), (35) are right. L = D Dᵀ is the undirected Laplacian; the loop holds "
            "D_in Dᵀ, where D_in keeps the receivers' entries alone."
        ),
        source=f"{_SOURCE}, (28) to (35)",
        kind="fixed",
        check=_j4,
        references=_REFERENCES,
        expected={
            "J4": "refuted",
            "J4:28": "refuted",
            "J4:identity": "refuted",
            "J4:34": "verified",
            "J4:loop": "verified",
        },
    ),
    Theorem(
        id="J5",
        title="A spacing of |N_i| cannot be had on a spanning tree",
        statement=(
            "With α_i r_i = |N_i| neighbours of different degree want different lengths of their edge, and with equal "
            "radii perception is mutual, so that no graph is a directed tree. On a frozen path of three the ends come "
            "to coincide 5/3 behind the middle, and all accelerate by 2/3 for ever."
        ),
        source=f"{_SOURCE}, assumptions",
        kind="fixed",
        check=_three_path,
        references=_REFERENCES,
        expected={"J5": "refuted", "J5:printed": "refuted", "J5:runaway": "verified"},
    ),
    Theorem(
        id="J6",
        title="Theorem 1 as it can be saved",
        statement=(
            "On frozen rooted out-trees with constant spacings, and on undirected trees with the reciprocal law, the "
            "edges take their desired lengths and velocities match, exponentially near a normally hyperbolic manifold "
            "of equilibria with (n - 1)(m - 1) zero modes."
        ),
        source=f"{_SOURCE}, Theorem 1; corrected by us",
        kind="fixed",
        check=_corrected,
        references=_REFERENCES,
        expected={
            f"J6{key}": "verified" for key in ("", ":directed-2", ":directed-3", ":undirected-2", ":undirected-3")
        },
    ),
)
