"""Theorem 3 of Olfati-Saber (2006): Algorithm 2 keeps the flock together."""

from __future__ import annotations

import numpy as np

from flockana.equilibria.terminal import terminal_state
from flockana.lattice import classify
from flockana.laws.olfati_saber import Algorithm2
from flockana.theorems.asymptotics import velocities_match
from flockana.theorems.claims import judged, vacuous
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.from_tube import enclosed_by
from flockana.theorems.hypotheses import condition, law_with_common_gains, positive
from flockana.theorems.leads import pairs_apart
from flockana.theorems.limits import limit_claim
from flockana.theorems.observed import Observed
from flockana.theorems.olfati_saber.attraction import final_basin
from flockana.theorems.olfati_saber.collisions import (
    below_multiple,
    below_the_barrier,
    distinct_pairs,
    no_collision,
    pairs_at_one_instant,
)
from flockana.theorems.olfati_saber.gamma_agent import consistent
from flockana.theorems.sampling import radius_over
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

PROOF = "matched-velocities"
_COLLISIONS = ("iv-printed", "iv-instant", "iv-none", "iv-barrier")


def _cohesive(seen: Observed, needs: list[Hypothesis]) -> Claim:
    """Claim (i), R below an explicit bound: ½ c1γ R² <= λ J <= H_λ(t) <= H_λ(0), between samples too."""
    radius, c1_gamma = radius_over(seen), seen.law.gains.c1_gamma
    bound = (2.0 * seen.energy[0] / c1_gamma).sqrt() if c1_gamma > 0.0 else Enclosure.of(np.inf)
    worst, largest = int(np.argmax(seen.radius.mid)), float(seen.radius.mid.max())
    return judged(
        "i",
        bound - radius.max(),
        needs,
        computed=largest,
        stated=f"R <= sqrt(2 H_λ(0)/c1γ) = {bound.mid:.5g}",
        witness={"time": float(seen.t[worst])},
        proof="cohesion",
        detail=f"cohesive: R <= {largest:.4g}, and H_λ(0) allows {bound.mid:.4g}",
    )


def _minimum(seen: Observed, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Claim (ii), that the limit is a local minimum of U_λ, strict but for rotations; a run cannot refute it."""
    end = terminal_state(seen.law, *seen.end[:2], contact=tolerances.contact)
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi)
    links = f"links off d by up to {100.0 * end.strain:.2g} %" if end.links else "no links"
    return limit_claim(
        "ii",
        needs,
        [final_basin(seen).certificate],
        computed=end.curvature,
        stated="the flock tends to a strict local minimum of U_λ (modulo rotations)",
        witness={"force": end.force, "K̃": end.mismatch, "strain": end.strain, "coincident pairs": end.coincident},
        detail=f"residual force {end.force:.2g}, curvature {end.curvature:.2g}; as a lattice: {kind}, {links}",
    )


def _check(seen: Observed, tolerances: Tolerances) -> Checked:
    gains = positive(seen, c1_gamma="c1γ", c2_gamma="c2γ")
    finite = condition("K(v(0)) and J(x(0)) are finite", True, detail="every state here is finite")
    needs, repels = [gains, finite], positive(seen, c1_alpha="c1α")
    claims = [
        _cohesive(seen, needs),
        _minimum(seen, needs, tolerances),
        velocities_match(seen, needs, name="iii", caught=[final_basin(seen).certificate], proof=PROOF),
    ]
    given = [*needs, consistent(seen.run), repels]  # nothing below needs dq_r/dt = p_r: it is about the moving frame
    if unmet([repels]):
        return given, [*claims, *(vacuous(name, repels) for name in _COLLISIONS)]
    energy = seen.energy[0]
    none = below_multiple(energy, seen.law.gains.c1_alpha * seen.law.alpha.c_star)
    barrier = below_the_barrier(seen, energy)  # U_λ >= c1α V: a bound of V will do
    return [*given, none, barrier], [  # (iv) needs gains >= 0 only, which every run has
        *claims,
        distinct_pairs(seen, [repels], tolerances, name="iv-printed"),
        pairs_at_one_instant(seen, [repels], tolerances, name="iv-instant", proof="collisions"),
        no_collision(seen, [repels, none], tolerances, name="iv-none", proof="collisions"),
        no_collision(seen, [repels, barrier], tolerances, name="iv-barrier"),
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
    corrected=("iv-instant",),
    ours=("iv-barrier",),
)
