"""Theorem 3 of Olfati-Saber (2006): Algorithm 2 keeps the flock together."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.equilibria.terminal import terminal_state
from flockana.lattice import classify
from flockana.laws.olfati_saber import Algorithm2
from flockana.theorems.asymptotics import velocities_match
from flockana.theorems.claims import judged
from flockana.theorems.from_tube import enclosed_by
from flockana.theorems.hypotheses import condition, law_with_common_gains, positive, vacuous
from flockana.theorems.leads import pairs_apart
from flockana.theorems.limits import limit_claim
from flockana.theorems.olfati_saber.attraction import final_basin
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
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

_COLLISIONS = ("iv-printed", "iv-instant", "iv-none", "iv-barrier")


def _cohesive(run: Trajectory, needs: list[Hypothesis], error: float) -> Claim:
    """Claim (i), R below an explicit bound: ½ c1γ R² <= λ J <= H_λ(t) <= H_λ(0), between samples too."""
    radius, c1_gamma = run.metric("cohesion_radius"), run.law.gains.c1_gamma
    worst, energy = int(np.argmax(radius)), float(run.energy()[0])
    largest = float(radius[worst])
    bound = sqrt(2.0 * energy / c1_gamma) if c1_gamma > 0.0 else inf
    blur = sqrt(2.0 * error / c1_gamma) if c1_gamma > 0.0 else 0.0  # of the bound, at worst: √(a + e) - √a <= √e
    off = min(blur, error / (c1_gamma * bound)) if c1_gamma > 0.0 and bound > 0.0 else blur
    between = float(radius_between(run).max(initial=largest)) - largest if largest < bound else 0.0
    error = off + sqrt(run.m) * frame_error(run.q) + between
    return judged(
        "i",
        bound - largest,
        error,
        needs,
        computed=largest,
        stated=f"R <= sqrt(2 H_λ(0)/c1γ) = {bound:.5g}",
        witness={"time": float(run.t[worst])},
        proof="cohesion",
        detail=f"cohesive: R <= {largest:.4g}, and H_λ(0) allows {bound:.4g}",
    )


def _minimum(run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Claim (ii), that the limit is a local minimum of U_λ, strict but for rotations; a run cannot refute it."""
    end = terminal_state(run.law, run.q[-1], run.p[-1], contact=tolerances.contact)
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi)
    links = f"links off d by up to {100.0 * end.strain:.2g} %" if end.links else "no links"
    return limit_claim(
        "ii",
        needs,
        [final_basin(run).certificate],
        computed=end.curvature,
        stated="the flock is caught by a strict local minimum of U_λ (modulo rotations)",
        witness={"force": end.force, "K̃": end.mismatch, "strain": end.strain, "coincident pairs": end.coincident},
        detail=f"residual force {end.force:.2g}, curvature {end.curvature:.2g}; as a lattice: {kind}, {links}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    gains = positive(run, c1_gamma="c1γ", c2_gamma="c2γ")
    finite = condition("K(v(0)) and J(x(0)) are finite", True, detail="every state here is finite")
    needs, repels = [gains, finite], positive(run, c1_alpha="c1α")
    error = float(energy_error(run.law, run.q[:1], run.p[:1], run.energy()[:1])[0])
    claims = [
        _cohesive(run, needs, error),
        _minimum(run, needs, tolerances),
        velocities_match(run, tolerances, needs, name="iii", caught=[final_basin(run).certificate]),
    ]
    given = [*needs, consistent(run), repels]  # nothing below needs dq_r/dt = p_r: it is about the moving frame
    if unmet([repels]):
        return given, [*claims, *vacuous(repels, _COLLISIONS)]
    energy = float(run.energy()[0])
    none = below_multiple(energy, error, run.law.gains.c1_alpha * run.law.alpha.c_star)
    barrier = below_the_barrier(run, energy, error)  # U_λ >= c1α V: a bound of V will do
    return [*given, none, barrier], [  # (iv) needs gains >= 0 only, which every run has
        *claims,
        distinct_pairs(run, [repels], tolerances, name="iv-printed"),
        pairs_at_one_instant(run, [repels], tolerances, name="iv-instant", proof="collisions"),
        no_collision(run, [repels, none], tolerances, name="iv-none", proof="collisions"),
        no_collision(run, [repels, barrier], tolerances, name="iv-barrier"),
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
    law=law_with_common_gains("Algorithm 2", Algorithm2),
    check=_check,
    enclosed=enclosed_by("os_3"),
    claims=("i", "ii", "iii", *_COLLISIONS),
    leads={"iv-printed": pairs_apart, "iv-instant": pairs_apart},
)
