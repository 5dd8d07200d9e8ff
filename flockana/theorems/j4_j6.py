"""Errata J4 to J6: signs, incompatible spacings, and the corrected Theorem 1 of the bearing-distance paper."""

from __future__ import annotations

import numpy as np

from flockana.laws.minimal import MinimalFlocking
from flockana.laws.perception import both_ways, edge_vectors, incidence, receivers
from flockana.simulate import simulate
from flockana.theorems import zone_1_corrected
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, Verdict, judge

_SOURCE = "Jond, bearing-distance flocking, section 4"
_REFERENCES = ("jond-2025",)
_TREE = ((0, 1), (1, 2), (1, 3), (0, 4))
_STARTS, _END = 20, 60.0
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
    return Claim(
        "loop",
        judge(1e-12 - error, 0.0, []),
        computed=error,
        stated="u = -D_in W^s Dᵀ p - D_in W^a Dᵀ v, with D_in where the text says 'like the incidence matrix'",
        margin=1e-12 - error,
        error=0.0,
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
    together, apart, pushed = [], [], []
    for seed in range(_STARTS):
        rng = np.random.default_rng(seed)
        run = simulate(law, rng.uniform(-2.0, 2.0, (3, 2)), rng.uniform(-1.0, 1.0, (3, 2)), (0.0, _END), t_eval=(_END,))
        ends = run.q[-1, [0, 2]] - run.q[-1, 1]
        together.append(float(np.linalg.norm(ends[0] - ends[1])))
        apart.append(np.linalg.norm(ends, axis=1))
        pushed.append(np.linalg.norm(run.u[-1], axis=1))
    errors = np.array(together), np.array(apart) - 5.0 / 3.0, np.array(pushed) - 2.0 / 3.0
    worst = max(float(np.abs(error).max()) for error in errors)
    settled = worst <= tolerances.lattice
    off = float(np.abs(np.array(apart) - 1.0).max())  # the ends want 1, the middle 2, and both edges become 5/3
    return [], [
        Claim(
            "printed",
            "refuted" if settled else "inconclusive",
            computed={"edges": float(np.mean(apart)), "wanted by the ends": 1.0, "wanted by the middle": 2.0},
            stated="| |x_e| - α_i r_i | -> 0 for all agents, with α_i r_i = |N_i|",
            margin=-off,
            error=worst,
            witness={"graph": "frozen undirected path of three", "seeds": _STARTS},
            proof=_PRINTED,
            detail="an edge between agents of different degree is wanted at two lengths at once; it ends at neither",
        ),
        Claim(
            "runaway",
            "verified" if settled else "inconclusive",
            computed={
                "ends apart": max(together),
                "edges": float(np.mean(apart)),
                "acceleration": float(np.mean(pushed)),
            },
            stated={"ends apart": 0.0, "edges": 5.0 / 3.0, "acceleration": 2.0 / 3.0},
            margin=tolerances.lattice - worst,
            error=0.0,
            witness={"starts": _STARTS, "t": _END},
            proof=_PRINTED,
            detail=f"from {_STARTS} of {_STARTS} starts the ends come to coincide 5/3 behind the middle, and all "
            f"accelerate by 2/3 for ever (to {worst:.1g})"
            if settled
            else f"not reached from all {_STARTS} starts by t = {_END:g}",
        ),
    ]


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
            found = Verdict("zone-1-corrected", tuple(hypotheses), tuple(parts))
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
