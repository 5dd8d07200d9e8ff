"""Theorem 1 of Olfati-Saber (2006): Algorithm 1, if the flock stays together."""

from __future__ import annotations

from math import sqrt

import numpy as np

from flockana.interactions import AlphaInteraction
from flockana.lattice import harborth
from flockana.laws.olfati_saber import Algorithm1, paper_pair
from flockana.theorems.asymptotics import lattice_limit, velocities_match
from flockana.theorems.from_tube import enclosed_by
from flockana.theorems.hypotheses import law_is, positive
from flockana.theorems.leads import strained
from flockana.theorems.limits import without_assumed
from flockana.theorems.observed import Observed
from flockana.theorems.olfati_saber.attraction import final_basin
from flockana.theorems.olfati_saber.collisions import (
    below_multiple,
    below_the_barrier,
    energy_at_end,
    energy_at_start,
    no_collision,
)
from flockana.theorems.olfati_saber.energy import proved
from flockana.theorems.sampling import nets_at
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet


def disconnected_energy(law: Algorithm1, n: int, m: int) -> float:
    """Energy of a state at rest that is no flock: the best lattice of n − 1 agents and one agent far away.

    ∞ where that lattice does not exist (κ too large) or n = 1.
    """
    if n < 2 or paper_pair(law).kappa >= (2.0 if m == 1 else sqrt(3.0)):
        return float("inf")
    bonds = n - 2 if m == 1 else harborth(n - 1)
    return law.gains.c1_alpha * law.alpha.far_potential * (n * (n - 1) // 2 - bonds)


def _stays_together(seen: Observed) -> Hypothesis:
    """The hypothesis on all solutions from Ω_c: this run can break it, and so can a disconnected state in Ω_c."""
    parts = nets_at(seen).components_least
    worst = int(np.argmax(parts))
    name = "every solution from Ω_c is a cohesive dynamic flock"
    if parts[worst] > 1:
        detail = f"this run is no flock at t = {seen.t[worst]:.4g}, where it has {int(parts[worst])} components"
        return Hypothesis(name, "unmet", 1.0 - float(parts[worst]), detail)
    energy, apart = energy_at_start(seen), disconnected_energy(seen.law, seen.n, seen.m)
    if energy.lo >= apart:
        detail = f"Ω_c holds a disconnected state at rest: its energy is {apart:.5g}, and c >= H(0) = {energy.mid:.5g}"
        return Hypothesis(name, "unmet", apart - float(energy.mid), detail)
    parted = (seen.n - 1) * seen.law.gains.c1_alpha * seen.law.alpha.far_potential
    for t, height in ((seen.t[0], energy), (seen.t[-1], energy_at_end(seen))):
        if height.hi < parted:  # limits are those of the start at that time
            detail = f"at t = {t:.4g} H = {height.mid:.5g}: a disconnected state has (n-1) c1α ψ_α(r_α) = {parted:.5g}"
            return Hypothesis(name, "met", parted - float(height.mid), detail, float(height.half_width))
    return Hypothesis(name, "assumed", detail="this run is connected at every sample; the others are not known")


def _barrier(seen: Observed) -> str | None:
    """The id of the proof of the barrier's bound, which counts up to 60 agents of the default law in the plane."""
    counted = seen.m == 2 and seen.n <= 61 and seen.law.alpha == AlphaInteraction()
    return proved(seen, "barrier") if counted else None


def _velocities(seen: Observed, needs: list[Hypothesis]) -> Claim:
    """Claim (ii): by the proof where the hypothesis on all solutions is met, else by a basin, whose flock stays one."""
    caught = [final_basin(seen).certificate]
    if needs[-1].status == "assumed" and caught[0].certain:
        return velocities_match(seen, needs[:-1], name="ii", caught=caught)
    return velocities_match(seen, needs, name="ii", caught=caught, proof="matched-velocities")


def _check(seen: Observed, tolerances: Tolerances) -> Checked:
    needs = [positive(seen, c1_alpha="c1α"), positive(seen, c2_alpha="c2α")]
    if unmet(needs):
        return needs, []
    energy = energy_at_start(seen)
    needs, c_star = [*needs, _stays_together(seen)], seen.law.gains.c1_alpha * seen.law.alpha.c_star
    low, barrier = below_multiple(energy, c_star), below_the_barrier(seen, energy)
    return [*needs, low, barrier], [
        without_assumed(needs, lambda given: lattice_limit(seen, given, tolerances, name="i")),
        _velocities(seen, needs),
        no_collision(seen, [*needs, low], tolerances, name="iii", proof=proved(seen, "collisions")),
        no_collision(seen, [*needs, barrier], tolerances, name="iii-barrier", proof=_barrier(seen)),
    ]


THEOREM = Theorem(
    id="os-1",
    title="Algorithm 1: lattice, matched velocities, no collision",
    statement=(
        "With c1α, c2α > 0, if every solution that starts in the level set H(x, v) <= c is a cohesive dynamic flock, "
        "(i) almost every solution converges to an equilibrium that is an α-lattice, (ii) velocities match in the "
        "moving frame, and (iii) if c < c* = ψ_α(0), no two agents ever collide."
    ),
    source="Olfati-Saber 2006, Theorem 1",
    kind="trajectory",
    law=law_is("Algorithm 1", Algorithm1),
    check=_check,
    enclosed=enclosed_by("os_1"),
    claims=("i", "ii", "iii", "iii-barrier"),
    leads={"i": strained},
    ours=("iii-barrier",),
)
