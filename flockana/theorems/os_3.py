"""Theorem 3 of Olfati-Saber (2006): Algorithm 2 keeps the flock together."""

from __future__ import annotations

from math import floor, sqrt

import numpy as np

from flockana.lattice import classify
from flockana.laws.olfati_saber import Algorithm2
from flockana.terminal import TerminalState, terminal_state
from flockana.theorems.asymptotics import (
    below_the_barrier,
    distinct_pairs,
    no_collision,
    pairs_at_one_instant,
    settled,
    velocities_match,
)
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory


def _hypotheses(run: Trajectory) -> tuple[list[Hypothesis], Hypothesis]:
    """(those that the claims need, and the γ-agent's consistency, which they do not)."""
    applies = type(run.law) is Algorithm2
    law = Hypothesis("Algorithm 2 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], Hypothesis("dq_r/dt = p_r", "unmet", detail="no γ-agent")
    gains = run.law.gains
    if gains.per_agent:
        single = Hypothesis("one c1γ and one c2γ for all agents", "unmet", detail="gains are given per agent")
        return [single], Hypothesis("dq_r/dt = p_r", "unmet", detail="no claim is judged")
    least = min(gains.c1_gamma, gains.c2_gamma)
    positive = Hypothesis(
        "c1γ > 0 and c2γ > 0",
        "met" if least > 0.0 else "unmet",
        least,
        f"c1γ = {gains.c1_gamma:g}, c2γ = {gains.c2_gamma:g}",
    )
    finite = Hypothesis("K(v(0)) and J(x(0)) are finite", "met", detail="every state here is finite")
    mismatch = run.law.target.mismatch(run.t[:: max(1, len(run.t) // 50)])
    consistent = Hypothesis(
        "dq_r/dt = p_r",
        "met" if mismatch <= 1e-6 else "unmet",
        -mismatch,
        "" if mismatch <= 1e-6 else f"p_r is off by up to {mismatch:.3g}; no claim below needs it (moving frame)",
    )
    return [law, positive, finite], consistent


def _cohesive(run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """(i) with its explicit bound: ½ c1γ R² <= λ J <= H_λ(t) <= H_λ(0)."""
    radius = run.metrics().cohesion_radius.values
    worst, c1_gamma = int(np.argmax(radius)), run.law.gains.c1_gamma
    bound = sqrt(2.0 * float(run.energy()[0]) / c1_gamma) if c1_gamma > 0.0 else float("inf")
    margin, error = bound - float(radius[worst]), 1e-9 * float(radius[worst])
    return Claim(
        "i",
        judge(margin, error, needs),
        computed=float(radius[worst]),
        stated=f"R <= sqrt(2 H_λ(0)/c1γ) = {bound:.5g}",
        margin=margin,
        error=error,
        witness={"time": float(run.t[worst])},
        proof="cohesion",
        detail=f"cohesive: R <= {radius[worst]:.4g}, and H_λ(0) allows {bound:.4g}",
    )


def _minimum(end: TerminalState, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """(ii): the limit is a local minimum of U_λ, by its Hessian off the rotations; one run cannot refute it."""
    margin = end.curvature - tolerances.curvature
    status = judge(margin, 0.0, needs)
    if status != "vacuous" and (status == "refuted" or not settled(end, tolerances)):
        status = "inconclusive"
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi)
    links = f"links off d by up to {100.0 * end.strain:.2g} %" if end.links else "no links"
    state = "equilibrium" if settled(end, tolerances) else "not yet an equilibrium"
    return Claim(
        "ii",
        status,
        computed=end.curvature,
        stated=f"least Hessian eigenvalue of U_λ off the rotations > 0 (over {tolerances.curvature:g} of the largest)",
        margin=margin,
        error=0.0,
        witness={"force": end.force, "K̃": end.mismatch, "strain": end.strain, "coincident pairs": end.coincident},
        detail=f"limit: {state} (residual force {end.force:.2g}), curvature {end.curvature:.2g}; as a lattice: {kind}, "
        f"{links}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    needs, consistent = _hypotheses(run)
    if needs[0].status == "unmet":
        names = ("i", "ii", "iii", "iv-printed", "iv-instant", "iv-none", "iv-barrier")
        return needs, [Claim(name, "vacuous", detail=needs[0].detail) for name in names]
    end = terminal_state(run.law, run.q[-1], run.p[-1], contact=tolerances.contact)
    c_star = run.law.gains.c1_alpha * run.law.alpha.c_star
    k = floor(float(run.energy()[0]) / c_star)
    collision_free = Hypothesis("H_λ(0) < c* (k = 0)", "met" if k == 0 else "unmet", detail=f"k = {k}")
    energy_falls = [needs[0]]  # gains >= 0 are enough for (iv)
    barrier = below_the_barrier(run, float(run.energy()[0]))  # U_λ >= c1α V: a bound of V will do
    return [*needs, consistent, collision_free, barrier], [
        _cohesive(run, needs),
        _minimum(end, needs, tolerances),
        velocities_match(run, tolerances, needs, name="iii"),
        distinct_pairs(run, needs[0], tolerances, c_star=c_star, name="iv-printed"),
        pairs_at_one_instant(run, needs[0], tolerances, c_star=c_star, name="iv-instant", proof="collisions"),
        no_collision(run, [*energy_falls, collision_free], tolerances, name="iv-none", proof="collisions"),
        no_collision(run, [*energy_falls, barrier], tolerances, name="iv-barrier"),
    ]


THEOREM = Theorem(
    id="os-3",
    title="Algorithm 2: cohesion, local minimum, matched velocities, few collisions",
    statement=(
        "With c1γ, c2γ > 0 and finite K(v(0)), J(x(0)): (i) the group stays cohesive, (ii) almost every solution "
        "converges to a local minimum of U_λ (no lattice in general), (iii) velocities match, (iv) if "
        "H_λ(0) < (k+1) c*, at most k distinct pairs can collide. (iv) holds per instant, and for k = 0; over time "
        "more pairs can collide (erratum E13)."
    ),
    source="Olfati-Saber 2006, Theorem 3",
    kind="trajectory",
    check=_check,
)
