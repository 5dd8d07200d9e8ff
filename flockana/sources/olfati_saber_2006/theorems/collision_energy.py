"""Energy of a collision: below c* none is possible, below 2 c* one pair may collide."""

from flockana.interactions import AlphaInteraction
from flockana.laws.composition import Composition
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.collisions import below_multiple, energy_at_start, no_collision
from flockana.theorems.energy import nothing_adds_energy
from flockana.theorems.hypotheses import alpha_gain, condition, law_is, positive
from flockana.theorems.meeting_energy import least_is_known, meeting
from flockana.theorems.theorem_toolkit import Checked, Hypothesis, Observed, Tolerances, run_theorem, unmet
from flockana.theorems.tube_claims import enclosed_by

_MULTIPLES = {"below": 1, "twice": 2}  # of c*, by claim


def _needs(run: Observed) -> list[Hypothesis]:
    """Return the hypotheses: a pair potential, and an energy that never rises."""
    if type(run.law) is not Composition and isinstance(run.law.alpha, AlphaInteraction):
        return alpha_gain(run)
    has_pair = condition("agents have a pair potential", run.law.alpha is not None)
    if run.law.alpha is None:
        return [has_pair]
    return [has_pair, positive(run, c1_alpha="c1α"), *nothing_adds_energy(run), *least_is_known(run)]


@run_theorem(
    "collision-energy",
    title="No collision below c*; above it there are some",
    source="Olfati-Saber 2006, Theorems 1(iii) and 3(iv); that the bound is sharp is ours",
    law=law_is("Algorithm 1 or 2", Algorithm1, Algorithm2, composed=True),
    enclosed=enclosed_by("collision_energy", f"{__package__}.theorems_1_and_3_enclosed"),
    claims=tuple(_MULTIPLES),
    references=("olfati-saber-2006", "flockana"),
    ours=("twice",),
)
def theorem(run: Observed, tolerances: Tolerances) -> Checked:
    """The energy of Algorithms 1 and 2 in the moving frame never rises, and a coincident pair alone holds c* = c1α
    ψ_α(0). So below c* no two agents ever meet, whether or not the flock stays together. The bound is sharp: two agents
    that approach head on can meet below 2 c*. The same holds for every composition whose terms add no energy, if the
    least energy of all other pairs is subtracted from H(0) and c* is the excess of a coincident pair over a pair's
    least energy.
    """
    if unmet(requirements := _needs(run)):
        return requirements, []
    pairs = meeting(run)
    energy_margin = energy_at_start(run) - pairs.floor
    bounds = {name: below_multiple(energy_margin, pairs.c_star, k) for name, k in _MULTIPLES.items()}
    claims = [no_collision(run, [*requirements, bound], tolerances, name=name) for name, bound in bounds.items()]
    return [*requirements, *bounds.values()], claims
