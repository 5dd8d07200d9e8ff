"""Theorem 1 of the bearing-distance paper as printed: the edges of a spanning tree vanish. They do not."""

from __future__ import annotations

import numpy as np

from flockana.laws.perception import edge_vectors, incidence
from flockana.theorems.asymptotics import velocities_match
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.theorems.tree_case import TreeCase, root_edges, tree_hypotheses
from flockana.trajectory import Trajectory

_PROOF = "bearing-distance-printed"
_NEUTRAL = 1e-9  # real parts below this are not told from zero


def _at_rest(case: TreeCase, run: Trajectory) -> Claim:
    """The counterexample: at rest with every edge at its desired length, where nothing moves and x is not 0."""
    q = case.on_manifold(run.q[-1])
    u = float(np.abs(case.law.flow(0.0, q, 0.0 * q)[0]).max())
    least, rounding = float(case.rho.min()), 1e-12 * float((case.mu * np.abs(q).max()).sum() + case.rho.max())
    return Claim(
        "equilibrium",
        "refuted" if u <= rounding else "inconclusive",
        computed=least,
        stated="x -> 0 from any initial condition",
        margin=-least,
        error=rounding,
        witness={"q": q.tolist(), "p": "0", "largest |u|": u},
        proof=_PROOF,
        detail=f"at rest with every edge at its desired length nothing moves (|u| <= {u:.1g}): |x_e| stays "
        f"{least:.4g} or more for ever",
    )


def _edges_vanish(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """x -> 0 on this run: an edge from the root whose V is small can never shorten to 0, so the limit is refuted."""
    length = np.linalg.norm(edge_vectors(run.q[-1], case.links), axis=1)
    floors = [floor for _, floor in root_edges(case, run.q[-1], run.p[-1]).values()]
    floor = max(floors, default=-1.0)
    status = judge(-floor, 0.0, needs)
    return Claim(
        "edges",
        status if status == "vacuous" else "refuted" if floor > 0.0 else "inconclusive",
        computed=[float(length.min()), float(length.max())],
        stated="|x_e| -> 0 on every edge",
        margin=-floor if floor > 0.0 else float("nan"),
        error=0.0,
        witness={"q(0)": run.q[0].tolist(), "p(0)": run.p[0].tolist(), "time": float(run.t[-1])},
        proof=_PROOF,
        detail=f"at t = {run.t[-1]:g} edges are {length.min():.6g} to {length.max():.6g} long"
        + (f", and V keeps one from the root above {floor:.4g} for ever" if floor > 0.0 else ""),
    )


def _hurwitz(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """A_cl along the run, with w_e = μ (1 − ρ/‖x_e‖): the proof calls it Hurwitz at every state."""
    D = incidence(case.n, case.links)
    laplacian = D.T @ np.maximum(D, 0.0)
    lengths = np.linalg.norm(edge_vectors(run.q, case.links), axis=2)
    k = int(np.argmin((lengths / case.rho).min(axis=1)))
    w = case.mu * (1.0 - case.rho / lengths[k])
    zero, one = np.zeros_like(laplacian), np.eye(len(w))
    abscissa = float(np.linalg.eigvals(np.block([[zero, one], [-laplacian * w, -laplacian * case.align]])).real.max())
    return Claim(
        "hurwitz",
        judge(-abscissa, _NEUTRAL, needs),
        computed=abscissa,
        stated="all eigenvalues of A_cl have negative real parts",
        margin=-abscissa,
        error=_NEUTRAL,
        witness={"time": float(run.t[k]), "|x_e|/ρ": (lengths[k] / case.rho).tolist()},
        proof=_PROOF,
        detail=f"at t = {run.t[k]:.4g}, with an edge at {(lengths[k] / case.rho).min():.4g} of its desired length, "
        f"A_cl has an eigenvalue with real part {abscissa:.4g}; Hurwitz it is only while all edges are too long",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    needs, case = tree_hypotheses(run)
    directed = case is not None and case.root is not None
    if case is not None and not directed:
        needs[-1] = Hypothesis("the graph is a spanning tree", "unmet", detail="undirected: no agent is a root")
    if case is None or not directed:
        return needs, [Claim(name, "vacuous", detail="another case") for name in ("edges", "velocities", "hurwitz")]
    return needs, [
        _at_rest(case, run),
        _edges_vanish(case, run, needs),
        velocities_match(run, tolerances, needs, name="velocities"),
        _hurwitz(case, run, needs),
    ]


THEOREM = Theorem(
    id="zone-1-printed",
    title="Bearing-distance Theorem 1 as printed: edges vanish on a spanning tree",
    statement=(
        "If the interaction graph of the minimal model is a spanning tree, the edge vectors x and their rates converge "
        "to zero from any initial condition, since A_cl is Hurwitz. False: x = 0 is collision; at rest with every edge "
        "at its desired length nothing moves; A_cl is Hurwitz only where all edges are longer than that."
    ),
    source="Jond, bearing-distance flocking, Theorem 1",
    kind="trajectory",
    check=_check,
    references=("jond-2025",),
)
