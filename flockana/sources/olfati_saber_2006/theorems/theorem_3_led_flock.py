"""Theorem 3 of Olfati-Saber (2006): Algorithm 2 keeps the flock together."""

from flockana.equilibria.final_state import TerminalState, terminal_state
from flockana.lattice import classify
from flockana.laws.olfati_saber import Algorithm2
from flockana.sources.olfati_saber_2006.theorems import any_potential
from flockana.theorems import collisions
from flockana.theorems.attraction_basin import final_basin
from flockana.theorems.gamma_agent_checks import consistent
from flockana.theorems.limit_claims import velocities_match
from flockana.theorems.search_objectives import pairs_apart
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import Observed, condition, law_is, limit_claim, positive, run_theorem, vacuous
from flockana.theorems.tube_claims import enclosed_by

_LIMIT = "convergence"  # the proof of what is known of (ii)
_PROOFS = ("cohesion", "collisions")  # of (i) and of (iv), for the paper's own pair law
_COLLISIONS = ("iv-printed", "iv-instant", "iv-none", "iv-barrier")


def _minimum(seen: Observed, needs: list[Hypothesis], end: TerminalState, tolerances: Tolerances) -> Claim:
    """Return claim (ii), that the limit is a local minimum of U_λ, strict up to rotations."""
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi).replace("neither", "no lattice")
    links = f"links off d by up to {100.0 * end.strain:.3g} %" if end.links else "no links"
    return limit_claim("ii", needs, [final_basin(seen).certificate], computed=end.curvature).described(
        stated="the flock tends to a strict local minimum of U_λ (modulo rotations)",
        witness={"force": end.force, "K̃": end.mismatch, "strain": end.strain, "coincident pairs": end.coincident},
        detail=f"residual force {end.force:.2g}, curvature {end.curvature:.2g}; {kind}, {links}",
    )


def _limits(seen: Observed, needs: list[Hypothesis], end: TerminalState) -> list[Claim]:
    """Return the proved claims of (ii): convergence for every start, ∇²U_λ >= 0 for almost every start."""
    pieces = Hypothesis("ψ is C², analytic in finitely many pieces", "assumed", detail="proved of the paper's law")
    needs = needs if any_potential.is_paper(seen) else [*needs, pieces]
    limit_text = "converges to one equilibrium (x, 0), that is ∇U_λ(x) = 0"
    semidefinite = "almost every start tends to an equilibrium with ∇²U_λ >= 0"
    force, bend = f"residual force {end.force:.2g} at the end", f"least curvature {end.curvature:.2g} at the end"
    return [
        limit_claim("ii-converges", needs, computed=end.force, stated=limit_text, proof=_LIMIT, detail=force),
        limit_claim("ii-semidefinite", needs, computed=end.curvature, stated=semidefinite, proof=_LIMIT, detail=bend),
    ]


@run_theorem(
    "os-3",
    title="Algorithm 2: cohesion, local minimum, matched velocities, few collisions",
    source="Olfati-Saber 2006, Theorem 3",
    law=law_is("Algorithm 2", Algorithm2, formulas=True, one_gain=True),
    enclosed=enclosed_by("os_3", f"{__package__}.theorems_1_and_3_enclosed"),
    claims=("i", "ii", "ii-converges", "ii-semidefinite", "iii", *_COLLISIONS),
    leads={"iv-printed": pairs_apart, "iv-instant": pairs_apart},
    corrected=("ii-semidefinite", "iv-instant"),
    ours=("iv-barrier",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """With c1γ, c2γ > 0 and finite K(v(0)), J(x(0)): (i) the group stays cohesive, (ii) almost every solution converges
    to a local minimum of U_λ (no lattice in general), (iii) velocities match, (iv) if H_λ(0) < (k+1) c*, at most k
    distinct pairs can collide. (iv) holds per instant, and for k = 0; over time more pairs can collide (erratum E13).
    Proved of (ii): each solution converges to one equilibrium, and almost every one to an equilibrium with ∇²U_λ >= 0;
    a strict minimum is certified by its basin. (i), (iii) and (iv) hold for every pair potential that `any-potential`
    admits.
    """
    gains, potential = positive(seen, c1_gamma="c1γ", c2_gamma="c2γ"), any_potential.potential_needs(seen)
    finite = condition("K(v(0)) and J(x(0)) are finite", True, detail="every state here is finite")
    needs, repels, none = [gains, finite, *potential], positive(seen, c1_alpha="c1α"), any_potential.never_meets(seen)
    end, caught = terminal_state(seen.law, *seen.end[:2], contact=tolerances.contact), final_basin(seen).certificate
    force_claims = any_potential.bounded_at_contact(seen, none)
    stay_proof, apart = _PROOFS if any_potential.is_paper(seen) else (any_potential.PROOF, any_potential.PROOF)
    claims = [
        any_potential.cohesive(seen, needs, name="i", proof=stay_proof),
        _minimum(seen, needs, end, tolerances),
        *_limits(seen, [*needs, *force_claims], end),
        velocities_match(seen, [*needs, *force_claims], name="iii", caught=[caught], proof=any_potential.LIMITS),
    ]
    # nothing below needs dq_r/dt = p_r: it is about the moving frame
    needed = [*needs, *force_claims, consistent(seen.run), repels]
    if unmet([repels]):
        return needed, any_potential.attribute_claims(seen, [*claims, *(vacuous(name, repels) for name in _COLLISIONS)])
    barrier = collisions.below_the_barrier(seen, seen.energy[0])  # U_λ >= c1α V: a bound of V will do
    few = [repels, *potential]
    claims += [  # (iv) needs gains >= 0 only, which every run has
        collisions.distinct_pairs(seen, few, tolerances, name="iv-printed"),
        collisions.pairs_at_one_instant(seen, few, tolerances, name="iv-instant", proof=apart),
        collisions.no_collision(seen, [*few, none], tolerances, name="iv-none", proof=apart),
        collisions.no_collision(seen, [*few, barrier], tolerances, name="iv-barrier"),
    ]
    return [*needed, none, barrier], any_potential.attribute_claims(seen, claims)
