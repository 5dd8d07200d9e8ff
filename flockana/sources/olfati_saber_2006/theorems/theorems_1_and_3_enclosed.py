"""Theorems 1 and 3 of Olfati-Saber (2006) and the collision energy, decided by a tube and its basin."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flint import arb, ctx

from flockana.certified.balls import exact
from flockana.certified.energies_in_balls import coincident_floor, coincident_state, disconnected_state
from flockana.certified.pair_laws_in_series import PairNumbers
from flockana.certified.structural_energy import BITS, gain
from flockana.certified.tube import Tube, down, up
from flockana.theorems import tube_claims
from flockana.theorems.claims import undecided, vacuous
from flockana.theorems.limit_certificates import without_assumed
from flockana.theorems.theorem_toolkit import Checked, Claim, Hypothesis, Tolerances, condition, positive, unmet

if TYPE_CHECKING:
    from flockana.certified.tube import BasinLike

_MULTIPLES = {"below": 1, "twice": 2}  # of c*, by claim


def _coincident_energy(tube: Tube) -> arb:
    """Return c1α ψ_α(0), which is c* times its gain."""
    return gain(tube.law) * PairNumbers.of_alpha(tube.law.alpha).c_star


def _below_c_star(tube: Tube, times: int = 1) -> Hypothesis:
    """Return the hypothesis that the initial energy is below k times that of a coincident pair, H(0) < k c*."""
    with ctx.workprec(BITS):
        name = "H(0) < c*" if times == 1 else f"H(0) < {times} c*"
        return tube_claims.below(name, tube.energy(0), times * _coincident_energy(tube))


def _below_barrier(tube: Tube) -> Hypothesis:
    """Return the hypothesis that H(0) is below the least potential V of any state with two coincident agents."""
    name, alpha, energy = "H(0) < min{V : two agents coincide}", tube.law.alpha, tube.energy(0)
    if tube.n < 2:
        return condition(name, True, detail="there is one agent")
    with ctx.workprec(BITS):
        low = gain(tube.law) * coincident_floor(alpha, tube.n, tube.m)
        text = f"H(0) is at most {up(energy.upper()):.6g}; the minimum is at least {down(low.lower()):.5g}"
        if energy < low:
            return tube_claims.certain(name, True, down((low - energy).lower()), text)
        high = gain(tube.law) * coincident_state(alpha, tube.n, tube.m)
        text = f"H(0) = {float(energy):.6g}; the minimum is at least {float(low):.5g} and at most {float(high):.5g}"
        if energy > high:
            return tube_claims.certain(name, False, up((high - energy).upper()), text)
    return Hypothesis(name, "assumed", down((low - energy).lower()), text)


def _stays_together(tube: Tube) -> Hypothesis:
    """Return the hypothesis of Theorem 1 that all solutions from Ω_c stay connected."""
    name = "every solution from Ω_c is a cohesive dynamic flock"
    reach = arb(exact(tube.law.alpha.r))
    for k, t in enumerate(tube.t[:-1]):
        possible_pairs = tube_claims.certain_links(dict(zip(tube.pairs, tube.distances_during(k), strict=True)), reach)[
            1
        ]
        if len(tube_claims.groups(tube.n, possible_pairs)) > 1:
            return tube_claims.certain(name, False, -1.0, f"the net is certainly not connected about t = {t:.4g}")
    with ctx.workprec(BITS):
        splitting_energy = disconnected_state(tube.law.alpha, tube.n, tube.m)
        excess = arb(0) if splitting_energy is None else tube.energy(0) - gain(tube.law) * splitting_energy
        margin = gain(tube.law) * (tube.n - 1) * PairNumbers.of_alpha(tube.law.alpha).far - tube.energy(0)
    if excess > 0:
        return tube_claims.certain(name, False, -down(excess.lower()), "Ω_c holds a disconnected state at rest")
    if margin > 0:
        text = "H(0) < (n-1) c1α ψ_α(r_α), which a disconnected state has"
        return tube_claims.certain(name, True, down(margin.lower()), text)
    return Hypothesis(name, "assumed", detail="the starts of this tube may stay connected; other starts are not known")


def os_1(tube: Tube, basin: BasinLike | None, tolerances: Tolerances) -> Checked:
    """Check Theorem 1 of Olfati-Saber (2006) for all starts enclosed by a tube."""
    if unmet(requirements := [positive(tube, c1_alpha="c1α"), positive(tube, c2_alpha="c2α")]):
        return requirements, []
    case, requirements = tube_claims.TubeAndBasin.of(tube, basin), [*requirements, _stays_together(tube)]
    low, barrier = _below_c_star(tube), _below_barrier(tube)
    matching = "ii", "K̃ -> 0", "velocities match in the moving frame"
    proof = "any-potential-limits" if tube.status == "complete" else None
    return [*requirements, low, barrier], [
        without_assumed(requirements, lambda given: _lattice(case, given, tolerances)),
        tube_claims.converges(case, requirements, *matching, proof)
        if requirements[-1].status == "met"
        else without_assumed(requirements, lambda given: tube_claims.converges(case, given, *matching)),
        tube_claims.no_collision(case, [*requirements, low], name="iii"),
        tube_claims.no_collision(case, [*requirements, barrier], name="iii-barrier"),
    ]


def _lattice(case: tube_claims.TubeAndBasin, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Return claim (i): the limit is an equilibrium with all links of length d, within the tolerance."""
    alpha, stated_text = case.tube.law.alpha, f"|link - d|/d <= {tolerances.lattice:g} in the limit"
    if case.basin is None:
        return tube_claims.in_the_limit(case, needs, name="i", stated=stated_text)
    with ctx.workprec(BITS):
        strain = tube_claims.rest_strain(case.basin, alpha)
        margin, largest = arb(tolerances.lattice) - strain, up(strain.upper())
    detail = f"every start converges to the basin's equilibrium, whose links are off d by up to {largest:.2g} d"
    return tube_claims.in_the_limit(case, needs, margin, name="i", computed=largest, stated=stated_text, detail=detail)


def os_3(tube: Tube, basin: BasinLike | None, tolerances: Tolerances) -> Checked:
    """Check Theorem 3 of Olfati-Saber (2006) for all starts enclosed by a tube."""
    gains = positive(tube, c1_gamma="c1γ", c2_gamma="c2γ")
    requirements, repels = [gains, condition("K(v(0)) and J(x(0)) are finite", True)], positive(tube, c1_alpha="c1α")
    case, is_complete = tube_claims.TubeAndBasin.of(tube, basin), tube.status == "complete"
    limit, matching = ("convergence", "any-potential-limits") if is_complete else (None, None)
    strict_text = "every start of the tube converges to a strict local minimum of U_λ (modulo rotations)"
    limit_text = "every start converges to one equilibrium, ∇U_λ(x) = 0"
    semidefinite = "almost every start tends to an equilibrium with ∇²U_λ >= 0"
    tube_only_case = tube_claims.TubeAndBasin(tube, None, "")  # a basin says nothing of other starts
    claims = [
        _cohesive(case, requirements),
        tube_claims.converges(case, requirements, "ii", strict_text, "the limit is a local minimum"),
        tube_claims.converges(case, requirements, "ii-converges", limit_text, "one limit", limit),
        tube_claims.in_the_limit(
            tube_only_case, requirements, name="ii-semidefinite", stated=semidefinite, proof=limit
        ),
        tube_claims.converges(case, requirements, "iii", "K̃ -> 0", "velocities match in the moving frame", matching),
    ]
    names = ("iv-printed", "iv-instant", "iv-none", "iv-barrier")
    if unmet([repels]):
        return [*requirements, repels], [*claims, *(vacuous(name, repels) for name in names)]
    below_c_star, barrier = _below_c_star(tube), _below_barrier(tube)
    return [*requirements, repels, below_c_star, barrier], [
        *claims,
        _few_pairs(case, repels),
        tube_claims.no_collision(case, [repels], name="iv-instant"),
        tube_claims.no_collision(case, [repels, below_c_star], name="iv-none"),
        tube_claims.no_collision(case, [repels, barrier], name="iv-barrier"),
    ]


def _cohesive(case: tube_claims.TubeAndBasin, needs: list[Hypothesis]) -> Claim:
    """Return claim (i), that the cohesion radius R stays below √(2 H(0)/c1γ), from the initial energy."""
    tube = case.tube
    if not tube.taken:
        return undecided("i", tube.message, needs, stated="R <= sqrt(2 H_λ(0)/c1γ)")
    with ctx.workprec(BITS):
        gain = arb(exact(tube.law.gains.c1_gamma))
        largest = float(tube.cohesion_radius().max())
        bound = (2 * tube.energy(0) / gain).nonnegative_part().sqrt() if gain > 0 else arb(1e300)
        margin = arb(bound.lower()) - largest
    cohesion_text = f"up to t = {tube.t[-1]:g}, and the energy allows {float(bound):.5g} at all times"
    return tube_claims.decided("i", margin, needs, proof="cohesion").described(
        computed=largest,
        stated=f"R <= sqrt(2 H_λ(0)/c1γ) = {float(bound):.5g}",
        detail=f"cohesion radius R <= {largest:.5g} {case.until if case.basin is None else cohesion_text}",
    )


def _few_pairs(case: tube_claims.TubeAndBasin, repels: Hypothesis) -> Claim:
    """Return printed claim (iv): at most k pairs collide if H(0) < (k+1) c*; certain without a collision."""
    tube = case.tube
    with ctx.workprec(BITS):
        pairs = int(up((tube.energy(0) / _coincident_energy(tube)).lower()))
    pair_count_claim = condition("k < n(n-1)/2", pairs < len(tube.pairs), float(len(tube.pairs) - pairs - 1))
    apart = tube_claims.no_collision(case, [repels, pair_count_claim], name="iv-printed")
    if apart.status in ("verified", "vacuous"):
        return apart
    return undecided("iv-printed", f"{apart.detail}; whether more pairs meet is open", [repels, pair_count_claim])


def collision_energy(tube: Tube, basin: BasinLike | None, tolerances: Tolerances) -> Checked:
    """Check the claims on the energy needed for collisions, for all starts enclosed by a tube."""
    requirements, case = [positive(tube, c1_alpha="c1α")], tube_claims.TubeAndBasin.of(tube, basin)
    if unmet(requirements):
        return requirements, []
    bounds = {name: _below_c_star(tube, times) for name, times in _MULTIPLES.items()}
    claims = [tube_claims.no_collision(case, [*requirements, bound], name=name) for name, bound in bounds.items()]
    return [*requirements, *bounds.values()], claims
