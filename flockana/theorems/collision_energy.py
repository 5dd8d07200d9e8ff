"""How much energy a collision takes: c* excludes it, twice c* does not."""

from __future__ import annotations

from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.asymptotics import no_collision
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances
from flockana.trajectory import Trajectory

_CLAIMS = {"below": 1.0, "twice": 2.0}


def _bounded(energy: float, bound: float, text: str) -> Hypothesis:
    detail = f"H(0) = {energy:.5g}, {text} = {bound:.5g}"
    return Hypothesis(f"H(0) < {text}", "met" if energy < bound else "unmet", bound - energy, detail)


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) in (Algorithm1, Algorithm2)
    law = Hypothesis("Algorithm 1 or 2 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim(name, "vacuous", detail="another law") for name in _CLAIMS]
    law_of, start = run.law, (run.q[0], run.p[0])
    moving = type(law_of) is Algorithm1  # the energy of Algorithm 2 is taken in the moving frame already
    energy = law_of.structural_energy(*start) if moving else float(run.energy()[0])
    c_star = law_of.gains.c1_alpha * law_of.alpha.c_star
    bounds = {name: _bounded(energy, k * c_star, "c*" if k == 1.0 else "2 c*") for name, k in _CLAIMS.items()}
    return [law, *bounds.values()], [
        no_collision(run, [law, bound], tolerances, name=name) for name, bound in bounds.items()
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
    check=_check,
    references=("olfati-saber-2006", "flockana"),
)
