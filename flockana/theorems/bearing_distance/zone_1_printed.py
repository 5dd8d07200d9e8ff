"""Theorem 1 of the bearing-distance paper as printed: that the edges of a spanning tree vanish (false)."""

from __future__ import annotations

from math import inf, nan, sqrt

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.bearing_distance.tree_case import TreeCase, length_error, minimal_law, tree_hypotheses
from flockana.theorems.bearing_distance.tree_limits import length_kept, velocity_claim
from flockana.theorems.claims import judged
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

_PROOF = "bearing-distance-printed"


def _at_rest(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The counterexample: at rest with every edge at its desired length, where nothing moves and x is not 0."""
    q = case.on_manifold(run.q[-1])
    u = float(np.abs(case.law.flow(0.0, q, 0.0 * q)[0]).max())
    kept, error = length_kept(case, q, 0.0 * q)
    return judged(
        "equilibrium",
        -kept,
        error,
        needs,
        verifies=False,
        computed=kept * float(case.rho.min()),
        stated="x -> 0 from any initial condition",
        witness={"q": q.tolist(), "p": "0", "largest |u|": u},
        proof=_PROOF,
        detail=f"at rest with every edge at its desired length nothing moves (|u| <= {u:.1g}): |x_e| stays "
        f"{case.rho.min():.4g} or more for ever",
    )


def _edges_vanish(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The claim x -> 0 on this run: refuted by an edge that has too little energy ever to shorten to 0."""
    length = case.lengths(run.q[-1])
    kept, error = length_kept(case, run.q[-1], run.p[-1])
    return judged(
        "edges",
        -kept if kept > 0.0 else nan,
        error,
        needs,
        computed=[float(length.min()), float(length.max())],
        stated="|x_e| -> 0 on every edge",
        witness={"q(0)": run.q[0].tolist(), "p(0)": run.p[0].tolist(), "time": float(run.t[-1])},
        proof=_PROOF,
        detail=f"at t = {run.t[-1]:g} edges are {length.min():.6g} to {length.max():.6g} long"
        + (f", and one keeps {kept:.4g} of its desired length or more for ever" if kept > 0.0 else ""),
    )


def _abscissa(case: TreeCase, lengths: np.ndarray) -> float:
    """Largest real part of the roots of s² + a s + w_e over all edges, w_e = μ (1 − ρ/‖x_e‖): those of A_cl (J3)."""
    abscissa = -inf
    for length, rho, mu, a in zip(lengths, case.rho, case.mu, case.align, strict=True):
        w = mu * (1.0 - rho / length) if length > 0.0 else -inf
        abscissa = max(abscissa, 0.5 * (sqrt(max(a * a - 4.0 * w, 0.0)) - a))
    return abscissa


def _hurwitz(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The claim that A_cl is Hurwitz all along the run: it is if and only if every edge is longer than desired.

    det(sI - A_cl) is the product of s² + a s + w_e, and w_e has the sign of |x_e| - ρ_e: the lengths decide.
    """
    at = case.lengths(run.q) / case.rho
    k = int(np.argmin(at.min(axis=1)))
    least = float(at[k].min())
    between = float((case.shortest(run) / case.rho).min()) if least > 1.0 else least
    error, abscissa = length_error(case, run), _abscissa(case, at[k] * case.rho)
    return judged(
        "hurwitz",
        nan if least > 1.0 >= between else between - 1.0,
        error,
        needs,
        computed=abscissa,
        stated="all eigenvalues of A_cl have negative real parts",
        witness={"time": float(run.t[k]), "|x_e|/ρ": at[k].tolist()},
        proof=_PROOF,
        detail=f"at t = {run.t[k]:.4g}, with an edge at {least:.4g} of its desired length, A_cl has an eigenvalue with "
        f"real part {abscissa:.4g}; Hurwitz it is only while all edges are too long",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs, case = tree_hypotheses(run)
    if case is not None and case.root is None:
        needs[1] = Hypothesis("the graph is a spanning tree", "unmet", detail="undirected: no agent is a root")
    if case is None or unmet(needs):
        return needs, []
    return needs, [
        _at_rest(case, run, needs),
        _edges_vanish(case, run, needs),
        velocity_claim(case, run, needs, stated="x' -> 0 on every edge"),
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
    law=minimal_law,
    check=_check,
    claims=("equilibrium", "edges", "velocities", "hurwitz"),
    references=("jond-2025",),
)
