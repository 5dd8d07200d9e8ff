"""Theorem 3 of Olfati-Saber (2006): Algorithm 2 keeps the flock together."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.equilibria.terminal import terminal_state
from flockana.lattice import classify
from flockana.laws.olfati_saber import Algorithm2
from flockana.theorems.asymptotics import velocities_match
from flockana.theorems.hypotheses import applied, one_gain, positive, vacuous
from flockana.theorems.leads import pairs_apart
from flockana.theorems.limits import limit_claim
from flockana.theorems.olfati_saber.attraction import held
from flockana.theorems.olfati_saber.collisions import (
    below_multiple,
    below_the_barrier,
    distinct_pairs,
    no_collision,
    pairs_at_one_instant,
)
from flockana.theorems.olfati_saber.gamma_agent import consistent
from flockana.theorems.rounding import energy_error, frame_error
from flockana.theorems.sampling import radius_between
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

_CLAIMS = ("i", "ii", "iii", "iv-printed", "iv-instant", "iv-none", "iv-barrier")


def _cohesive(run: Trajectory, needs: list[Hypothesis], error: float) -> Claim:
    """(i) with its explicit bound: ½ c1γ R² <= λ J <= H_λ(t) <= H_λ(0), between samples too."""
    radius, c1_gamma = run.metric("cohesion_radius"), run.law.gains.c1_gamma
    worst, energy = int(np.argmax(radius)), float(run.energy()[0])
    largest = float(radius[worst])
    bound = sqrt(2.0 * energy / c1_gamma) if c1_gamma > 0.0 else inf
    blur = sqrt(2.0 * error / c1_gamma) if c1_gamma > 0.0 else 0.0  # of the bound, at worst: √(a + e) - √a <= √e
    off = min(blur, error / (c1_gamma * bound)) if c1_gamma > 0.0 and bound > 0.0 else blur
    between = float(radius_between(run).max(initial=largest)) - largest if largest < bound else 0.0
    error = off + sqrt(run.m) * frame_error(run.q) + between
    return Claim(
        "i",
        judge(bound - largest, error, needs),
        computed=largest,
        stated=f"R <= sqrt(2 H_λ(0)/c1γ) = {bound:.5g}",
        margin=bound - largest,
        error=error,
        witness={"time": float(run.t[worst])},
        proof="cohesion",
        detail=f"cohesive: R <= {largest:.4g}, and H_λ(0) allows {bound:.4g}",
    )


def _minimum(run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """(ii): the limit is a local minimum of U_λ, strict but for the rotations; one run cannot refute it."""
    end = terminal_state(run.law, run.q[-1], run.p[-1], contact=tolerances.contact)
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi)
    links = f"links off d by up to {100.0 * end.strain:.2g} %" if end.links else "no links"
    return limit_claim(
        "ii",
        needs,
        [held(run).certificate],
        computed=end.curvature,
        stated="the flock is caught by a strict local minimum of U_λ (modulo rotations)",
        witness={"force": end.force, "K̃": end.mismatch, "strain": end.strain, "coincident pairs": end.coincident},
        detail=f"residual force {end.force:.2g}, curvature {end.curvature:.2g}; as a lattice: {kind}, {links}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    law = applied(run, "Algorithm 2", Algorithm2)
    single = one_gain(run) if law.status == "met" else law
    if nothing := vacuous([single], _CLAIMS):
        return [single], nothing
    gains = positive(run, c1_gamma="c1γ", c2_gamma="c2γ")
    finite = Hypothesis("K(v(0)) and J(x(0)) are finite", "met", detail="every state here is finite")
    needs, repels = [law, gains, finite], positive(run, c1_alpha="c1α")
    error = float(energy_error(run.law, run.q[:1], run.p[:1], run.energy()[:1])[0])
    claims = [
        _cohesive(run, needs, error),
        _minimum(run, needs, tolerances),
        velocities_match(run, tolerances, needs, name="iii", caught=[held(run).certificate]),
    ]
    found = [*needs, consistent(run), repels]  # nothing below needs dq_r/dt = p_r: it is about the moving frame
    if nothing := vacuous([repels], _CLAIMS[3:]):
        return found, [*claims, *nothing]
    energy, falls = float(run.energy()[0]), [law, repels]  # gains >= 0 are enough for (iv)
    none = below_multiple(energy, error, run.law.gains.c1_alpha * run.law.alpha.c_star)
    barrier = below_the_barrier(run, energy, error)  # U_λ >= c1α V: a bound of V will do
    return [*found, none, barrier], [
        *claims,
        distinct_pairs(run, falls, tolerances, name="iv-printed"),
        pairs_at_one_instant(run, falls, tolerances, name="iv-instant", proof="collisions"),
        no_collision(run, [*falls, none], tolerances, name="iv-none", proof="collisions"),
        no_collision(run, [*falls, barrier], tolerances, name="iv-barrier"),
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
    leads={"iv-printed": pairs_apart, "iv-instant": pairs_apart},
)
