"""How much energy a collision takes: c* excludes it, twice c* does not."""

from __future__ import annotations

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.from_tube import enclosed_by
from flockana.theorems.hypotheses import alpha_gain, law_is
from flockana.theorems.olfati_saber.collisions import below_multiple, no_collision
from flockana.theorems.rounding import energy_error
from flockana.theorems.theorem import Checked, Theorem, Tolerances, unmet

_MULTIPLES = {"below": 1, "twice": 2}  # of c*, by claim


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs = alpha_gain(run)
    if unmet(needs):
        return needs, []
    energy = run.law.structural_energy(run.q[0], run.p[0])
    error = float(energy_error(run.law, run.q[:1], run.p[:1], np.array([energy]))[0])
    c_star = run.law.gains.c1_alpha * run.law.alpha.c_star
    bounds = {name: below_multiple(energy, error, c_star, k) for name, k in _MULTIPLES.items()}
    return [*needs, *bounds.values()], [
        no_collision(run, [*needs, bound], tolerances, name=name) for name, bound in bounds.items()
    ]


THEOREM = Theorem(
    id="collision-energy",
    title="No collision below c*; above it there are some",
    statement=(
        "The energy of Algorithms 1 and 2 in the moving frame never rises, and a coincident pair alone holds c* = "
        "c1α ψ_α(0). So below c* no two agents ever meet, whether or not the flock stays together. The bound is sharp: "
        "that none meet below 2 c* is false, as two agents show that approach head on."
    ),
    source="Olfati-Saber 2006, Theorems 1(iii) and 3(iv); that the bound is sharp is ours",
    kind="trajectory",
    law=law_is("Algorithm 1 or 2", Algorithm1, Algorithm2),
    check=_check,
    enclosed=enclosed_by("collision_energy"),
    claims=tuple(_MULTIPLES),
    references=("olfati-saber-2006", "flockana"),
)
