"""Theorems 1 and 3 for every pair potential with the properties used in their proofs.

They ask for a potential that is C¹ up to its range and at least L, and an adjacency that is nowhere negative. All is
said of E = H − c1α L n(n − 1)/2, the energy above the least that all pairs together can have.
"""

from dataclasses import replace
from math import inf, sqrt

import numpy as np

from flockana.equilibria.gradient_flow import structural_force
from flockana.interactions import AlphaInteraction
from flockana.lattice import harborth
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, paper_pair
from flockana.theorems import collisions
from flockana.theorems.bounds_between_samples import nets_at, radius_over
from flockana.theorems.hypotheses import hypothesis_from_fact, smooth_pair, weight_nonnegative
from flockana.theorems.limit_certificates import decays_to_zero
from flockana.theorems.limit_claims import velocities_match
from flockana.theorems.meeting_energy import above_least, least_is_known, meeting
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import (
    Enclosure,
    Observed,
    condition,
    judged,
    law_is,
    positive,
    run_theorem,
    vacuous,
)

PROOF, LIMITS = "any-potential", "any-potential-limits"
_ROUNDING = 1e-12  # of a potential
_PARTS = 4  # of the range, on which slopes are bounded


def is_paper(seen: Observed) -> bool:
    """Return whether the pair law is that of Olfati-Saber (2006), whose properties are all proved."""
    return isinstance(seen.law.alpha, AlphaInteraction)


def attribute_claims(seen: Observed, claims: list[Claim]) -> list[Claim]:
    """Return claims attributed to Olfati-Saber (2006), or to flockana for pair laws not in the paper."""
    return claims if is_paper(seen) else [replace(claim, by="flockana") for claim in claims]


def potential_needs(seen: Observed) -> list[Hypothesis]:
    """Return the theorems' unproved hypotheses on the pair potential and its adjacency."""
    low = meeting(seen).floor > -inf
    requirements = [smooth_pair(seen), condition("the pair potential is bounded below", low), weight_nonnegative(seen)]
    return [requirement for requirement in [*requirements, *least_is_known(seen)] if requirement.status != "met"]


def weight_inside(seen: Observed) -> list[Hypothesis]:
    """Return the hypothesis that weights a_ij are positive below the range, in a list; empty if proved."""
    inside_fact = hypothesis_from_fact("a_ij > 0 at every distance below the range", seen.law.alpha.facts.inside)
    return [inside_fact] if inside_fact.status != "met" else []


def bounded_at_contact(seen: Observed, apart: Hypothesis) -> list[Hypothesis]:
    """Return the hypothesis that forces and weights are bounded at reachable distances; empty if known."""
    if apart.status == "met" or is_paper(seen):
        return []
    slopes = seen.law.alpha.slopes(_PARTS)
    if all(np.isfinite([slope.force, slope.adjacency]).all() for slope in slopes):
        return []
    name = "force and adjacency are bounded at contact, or no two agents meet"
    return [Hypothesis(name, "assumed", detail="no bound of their slopes near contact is known")]


def continuous_force(seen: Observed, apart: Hypothesis) -> list[Hypothesis]:
    """Return the hypothesis that forces are continuous at reachable distances; empty if known."""
    if apart.status == "met" or seen.law.alpha.coincidence:
        return []
    return [Hypothesis("no two agents meet", "assumed", detail="their force has no limit where they do")]


def never_meets(seen: Observed) -> Hypothesis:
    """Return the hypothesis that the energy at the start keeps all pairs apart, E(0) < c*."""
    energy = seen.energy[0] if isinstance(seen.law, Algorithm2) else collisions.energy_at_start(seen)
    return collisions.below_multiple(above_least(seen, energy), meeting(seen).c_star)


def disconnected_energy(law: Algorithm1, n: int, m: int) -> float:
    """Return the energy of a resting split state: the best lattice of n − 1 agents, and one agent far away."""
    # ∞ where that lattice does not exist (κ too large) or n = 1. Under another pair law than the paper's, all are far.
    pairs, far_energy = n * (n - 1) // 2, law.gains.c1_alpha * law.alpha.far_potential
    if n > 1 and not isinstance(law.alpha, AlphaInteraction):
        return far_energy * pairs
    if n < 2 or paper_pair(law).kappa >= (2.0 if m == 1 else sqrt(3.0)):
        return inf
    return far_energy * (pairs - (n - 2 if m == 1 else harborth(n - 1)))


def parting_energy(seen: Observed) -> float:
    """Return the least known energy E of a flock split in two, (n − 1) c1α (ψ(r) − L)."""
    pair = seen.law.alpha
    energy = 0.0 if is_paper(seen) else pair.facts.least[0]
    margin = pair.far_potential - energy
    error = _ROUNDING * (abs(pair.far_potential) + abs(energy)) if np.isfinite(margin) else 0.0
    energy_margin = seen.law.gains.c1_alpha * (margin - error) if margin > error else 0.0
    return (seen.n - 1) * energy_margin if seen.n > 1 else inf


def stays_together(seen: Observed) -> Hypothesis:
    """Return the hypothesis that all solutions from Ω_c stay connected, from the energy that a split needs."""
    parts = nets_at(seen).components_least
    worst = int(np.argmax(parts))
    name = "every solution from Ω_c is a cohesive dynamic flock"
    if parts[worst] > 1:
        detail = f"this run is no flock at t = {seen.t[worst]:.4g}, where it has {int(parts[worst])} components"
        return Hypothesis(name, "unmet", 1.0 - float(parts[worst]), detail, decided="enclosed")
    energy, apart = collisions.energy_at_start(seen), disconnected_energy(seen.law, seen.n, seen.m)
    if energy.lo >= apart:
        detail = f"Ω_c holds a disconnected state at rest: its energy is {apart:.5g}, and c >= H(0) = {energy.mid:.5g}"
        margin = apart - float(energy.mid)
        return Hypothesis(name, "unmet", margin, detail, decided="enclosed", remedy=collisions.LESS_ENERGY)
    parted, of = parting_energy(seen), "ψ_α(r_α)" if is_paper(seen) else "(ψ(r) - L)"
    what = "H" if is_paper(seen) else "E"
    for t, height in ((seen.t[0], energy), (seen.t[-1], collisions.energy_at_end(seen))):
        if (height := above_least(seen, height)).hi < parted:  # limits are those of the start at that time
            detail = f"at t = {t:.4g} {what} = {height.mid:.5g}: a disconnected state has (n-1) c1α {of} = {parted:.5g}"
            return Hypothesis(
                name, "met", parted - float(height.mid), detail, float(height.half_width), decided="enclosed"
            )
    return Hypothesis(name, "assumed", detail="this run is connected at every sample; other solutions are not known")


def cohesive(seen: Observed, needs: list[Hypothesis], *, name: str, proof: str = PROOF) -> Claim:
    """Return the claim that the cohesion radius R is bounded under Algorithm 2 by √(2 E(0)/c1γ)."""
    c1_gamma, energy_margin = seen.law.gains.c1_gamma, above_least(seen, seen.energy[0])
    bound = (2.0 * energy_margin / c1_gamma).sqrt() if c1_gamma > 0.0 else Enclosure.of(np.inf)
    text = "sqrt(2 H_λ(0)/c1γ)" if is_paper(seen) else "sqrt(2 E(0)/c1γ)"
    return _within(seen, bound, needs, name, text, proof)


def _within(seen: Observed, bound: Enclosure, needs: list[Hypothesis], name: str, text: str, proof: str) -> Claim:
    """Return the claim that the cohesion radius R stays below a bound."""
    worst, largest = int(np.argmax(seen.radius.mid)), float(seen.radius.mid.max())
    return judged(name, bound - radius_over(seen).max(), needs, proof=proof, computed=largest).described(
        stated=f"R <= {text} = {bound.mid:.5g}",
        witness={"time": float(seen.t[worst])},
        detail=f"cohesion radius R <= {largest:.4g}, and {text} allows {bound.mid:.4g}",
    )


def critical(seen: Observed, needs: list[Hypothesis], *, name: str) -> Claim:
    """Return the claim that potential forces tend to 0, so that the flock tends to critical points."""
    forces = [np.linalg.norm(structural_force(seen.law, q), axis=1).max() for q in seen.run.q[[0, -1]]]
    stated_text = "the largest force on an agent at rest -> 0"
    return decays_to_zero(seen, name, needs, series=forces, what="the largest force", stated=stated_text, proof=LIMITS)


def _needs(seen: Observed) -> list[Hypothesis]:
    """Return the hypotheses on gains, potential and net of Theorem 1 or 3 for any pair potential."""
    if isinstance(seen.law, Algorithm2):
        return [positive(seen, c1_gamma="c1γ", c2_gamma="c2γ"), *potential_needs(seen)]
    gains = [positive(seen, c1_alpha="c1α"), positive(seen, c2_alpha="c2α")]
    requirements = [*gains, *weight_inside(seen), *potential_needs(seen)]
    return requirements if unmet(requirements) else [*requirements, stays_together(seen)]


@run_theorem(
    "any-potential",
    title="Algorithms 1 and 2 with any pair potential: cohesion, matched velocities, rest, few collisions",
    source="ours, on Olfati-Saber 2006, Theorems 1 and 3",
    law=law_is("Algorithm 1 or 2", Algorithm1, Algorithm2, formulas=True, one_gain=True),
    claims=("cohesion", "velocities", "critical", "one-instant", "no-collision"),
    references=("olfati-saber-2006", "flockana"),
    author="flockana",
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let ψ be C¹ on (0, r], constant from r on and at least L, a_ij >= 0, and E = H - c1α L n(n-1)/2. Under Algorithm
    2 with c1γ, c2γ > 0 R <= sqrt(2 E(0)/c1γ), velocities match, and forces tend to 0. Velocities match and forces tend
    to 0 also under Algorithm 1 with c1α, c2α > 0 and a_ij > 0 below r, in a flock that stays connected, as it does if
    E(0) < (n-1) c1α (ψ(r) - L). At most E/c* pairs coincide at one time, c* = c1α (ψ(0) - L), and none ever do if E(0)
    < c*, or if ψ is unbounded at contact.
    """
    if unmet(needs := _needs(seen)):
        return needs, []
    no_meeting, repels = never_meets(seen), positive(seen, c1_alpha="c1α")
    force_claims, steady = bounded_at_contact(seen, no_meeting), continuous_force(seen, no_meeting)
    if isinstance(seen.law, Algorithm2):
        cohesion = cohesive(seen, needs, name="cohesion")
    else:
        reach = Enclosure.around(0.5 * (seen.n - 1) * seen.law.alpha.range, 0.0)
        cohesion = _within(seen, reach, needs, "cohesion", "½ (n - 1) r", PROOF)
    instant_claim = (
        vacuous("one-instant", repels)
        if repels.status == "unmet"  # then c* = 0
        else collisions.pairs_at_one_instant(seen, [*needs, repels], tolerances, name="one-instant", proof=PROOF)
    )
    return [*needs, *force_claims, *steady, no_meeting], [
        cohesion,
        velocities_match(seen, [*needs, *force_claims], name="velocities", proof=LIMITS),
        critical(seen, [*needs, *force_claims, *steady], name="critical"),
        instant_claim,
        collisions.no_collision(seen, [*needs, repels, no_meeting], tolerances, name="no-collision", proof=PROOF),
    ]
