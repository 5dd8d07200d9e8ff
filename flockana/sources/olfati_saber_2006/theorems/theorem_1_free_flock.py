"""Theorem 1 of Olfati-Saber (2006): Algorithm 1, if the flock stays together."""

from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm1
from flockana.sources.olfati_saber_2006.theorems import any_potential
from flockana.theorems.attraction_basin import final_basin
from flockana.theorems.collisions import below_the_barrier, energy_at_start, no_collision
from flockana.theorems.energy import proved
from flockana.theorems.hypotheses import law_is, positive
from flockana.theorems.limit_certificates import without_assumed
from flockana.theorems.limit_claims import lattice_limit, velocities_match
from flockana.theorems.search_objectives import strained
from flockana.theorems.theorem_toolkit import Checked, Claim, Hypothesis, Observed, Tolerances, run_theorem, unmet
from flockana.theorems.tube_claims import enclosed_by


def _velocities(seen: Observed, needs: list[Hypothesis], bounded: list[Hypothesis]) -> Claim:
    """Return claim (ii), matching velocities: by the proof if all its hypotheses are met, else by a basin."""
    certificates = [final_basin(seen).certificate]
    if needs[-1].status == "assumed" and certificates[0].certain:
        return velocities_match(seen, needs[:-1], name="ii", caught=certificates)
    return velocities_match(seen, [*needs, *bounded], name="ii", caught=certificates, proof=any_potential.LIMITS)


@run_theorem(
    "os-1",
    title="Algorithm 1: lattice, matched velocities, no collision",
    source="Olfati-Saber 2006, Theorem 1",
    law=law_is("Algorithm 1", Algorithm1, formulas=True),
    enclosed=enclosed_by("os_1", f"{__package__}.theorems_1_and_3_enclosed"),
    claims=("i", "ii", "iii", "iii-barrier"),
    leads={"i": strained},
    ours=("iii-barrier",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """With c1α, c2α > 0, if every solution that starts in the level set H(x, v) <= c is a cohesive dynamic flock, (i)
    almost every solution converges to an equilibrium that is an α-lattice, (ii) velocities match in the moving frame,
    and (iii) if c < c* = ψ_α(0), no two agents ever collide. Our addition: the hypothesis is met if H(0) < (n-1) c1α
    ψ_α(r_α), as in a disconnected net at least n - 1 pairs are out of range; and (ii) and (iii) hold for every pair
    potential that `any-potential` admits.
    """
    gains = [positive(seen, c1_alpha="c1α"), positive(seen, c2_alpha="c2α")]
    if unmet(needs := [*gains, *any_potential.weight_inside(seen), *any_potential.potential_needs(seen)]):
        return needs, []
    low, barrier = any_potential.never_meets(seen), below_the_barrier(seen, energy_at_start(seen))
    needs, force_claims = [*needs, any_potential.stays_together(seen)], any_potential.bounded_at_contact(seen, low)
    collision_proof = proved(seen, "collisions") if any_potential.is_paper(seen) else any_potential.PROOF
    # the proof of the barrier's bound counts up to 60 agents of the default law in the plane
    is_counted = seen.m == 2 and seen.n <= 61 and seen.law.alpha == AlphaInteraction()
    barrier_proof = proved(seen, "barrier") if is_counted else None
    claims = [
        without_assumed(needs, lambda given: lattice_limit(seen, given, tolerances, name="i")),
        _velocities(seen, needs, force_claims),
        no_collision(seen, [*needs, low], tolerances, name="iii", proof=collision_proof),
        no_collision(seen, [*needs, barrier], tolerances, name="iii-barrier", proof=barrier_proof),
    ]
    return [*needs, *force_claims, low, barrier], any_potential.attribute_claims(seen, claims)
