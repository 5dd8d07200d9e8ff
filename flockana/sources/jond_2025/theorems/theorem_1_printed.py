"""Printed Theorem 1 of the bearing-distance paper: the edges of a spanning tree vanish (false)."""

from math import inf, sqrt

import numpy as np

from flockana.sources.jond_2025.theorems.tree_case import TreeCase, minimal_law, tree_hypotheses
from flockana.sources.jond_2025.theorems.tree_limits import kept, state, velocity_claim
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import Certificate, Enclosure, Observed, judged, limit_claim, run_theorem


def _at_rest(case: TreeCase, seen: Observed, needs: list[Hypothesis]) -> Claim:
    """Return the counterexample at rest with every edge at its desired length, where x does not tend to 0."""
    q = case.on_manifold(seen.run.q[-1])
    u = float(np.abs(case.law.flow(0.0, q, 0.0 * q)[0]).max())
    energy = kept(case, state(q, 0.0 * q))
    margin = Enclosure.of(-energy)
    return judged("equilibrium", margin, needs, about="all", disproof="bearing-distance-printed").described(
        computed=energy * float(case.rho.min()),
        stated="x -> 0 from any initial condition",
        witness={"q": q.tolist(), "p": "0", "largest |u|": u},
        detail=f"at rest with every edge at its desired length nothing moves (|u| <= {u:.1g}): every |x_e| "
        f"stays at its value of {case.rho.min():.4g} or more",
    )


def _edges_vanish(case: TreeCase, seen: Observed, needs: list[Hypothesis]) -> Claim:
    """Return the claim that edge vectors tend to 0, refuted by an edge with too little energy to shorten to 0."""
    distance, energy = case.lengths(seen.run.q[-1]), kept(case, seen.end)
    text = f"one edge never falls below {energy:.4g} of its desired length"
    return limit_claim("edges", needs, escape=Certificate(energy, text, 0.0)).described(
        computed=[float(distance.min()), float(distance.max())],
        stated="|x_e| -> 0 on every edge",
        witness={"q(0)": seen.run.q[0].tolist(), "p(0)": seen.run.p[0].tolist(), "time": float(seen.t[-1])},
        detail=f"at t = {seen.t[-1]:g} edges are {distance.min():.6g} to {distance.max():.6g} long",
    )


def _abscissa(case: TreeCase, lengths: np.ndarray) -> float:
    """Return the largest real part of the eigenvalues of A_cl, s² + a s + μ (1 − ρ/‖x_e‖) over all edges (J3)."""
    abscissa = -inf
    for distance, rho, mu, a in zip(lengths, case.rho, case.mu, case.align, strict=True):
        w = mu * (1.0 - rho / distance) if distance > 0.0 else -inf
        abscissa = max(abscissa, 0.5 * (sqrt(max(a * a - 4.0 * w, 0.0)) - a))
    return abscissa


def _hurwitz(case: TreeCase, seen: Observed, needs: list[Hypothesis]) -> Claim:
    """Return the claim that A_cl is Hurwitz along the run, which holds if every edge is longer than desired."""
    # det(sI - A_cl) is the product of s² + a s + w_e, and w_e has the sign of |x_e| - ρ_e: the lengths decide.
    at = case.lengths(seen.run.q) / case.rho
    sampled = (case.edges_of(seen.run.q, seen.shape_error) / case.rho - 1.0).worst
    k = int(np.argmin(at.min(axis=1)))
    abscissa = _abscissa(case, at[k] * case.rho)
    return judged("hurwitz", sampled if sampled.hi < 0.0 else case.shortest(seen) / case.rho - 1.0, needs).described(
        computed=abscissa,
        stated="all eigenvalues of A_cl have negative real parts",
        witness={"time": float(seen.t[k]), "|x_e|/ρ": at[k].tolist()},
        detail=f"at t = {seen.t[k]:.4g}, with an edge at {at[k].min():.4g} of its desired length, A_cl has an "
        f"eigenvalue with real part {abscissa:.4g}; it is Hurwitz only while all edges are longer than desired",
    )


@run_theorem(
    "zone-1-printed",
    title="Bearing-distance Theorem 1 as printed: edges vanish on a spanning tree",
    source="Jond, bearing-distance flocking, Theorem 1",
    law=minimal_law,
    claims=("equilibrium", "edges", "velocities", "hurwitz"),
    references=("jond-2025",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """If the interaction graph of the minimal model is a spanning tree, the edge vectors x and their rates converge to
    zero from any initial condition, since A_cl is Hurwitz. False: x = 0 is collision; at rest with every edge at its
    desired length nothing moves; A_cl is Hurwitz only where all edges are longer than that.
    """
    requirements, case = tree_hypotheses(seen)
    if case is not None and case.root is None:
        requirements[1] = Hypothesis("the graph is a spanning tree", "unmet", detail="undirected: no agent is a root")
    if case is None or unmet(requirements):
        return requirements, []
    return requirements, [
        _at_rest(case, seen, requirements),
        _edges_vanish(case, seen, requirements),
        velocity_claim(case, seen, requirements, stated="x' -> 0 on every edge"),
        _hurwitz(case, seen, requirements),
    ]
