"""Theorem 1 of Olfati-Saber (2006): Algorithm 1, if the flock stays together."""

from __future__ import annotations

from math import sqrt

import numpy as np

from flockana.lattice import harborth
from flockana.laws.olfati_saber import Algorithm1
from flockana.theorems.asymptotics import below_the_barrier, lattice_limit, no_collision, velocities_match
from flockana.theorems.energy import proved
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances
from flockana.trajectory import Trajectory


def _disconnected_energy(law: Algorithm1, n: int, m: int) -> float:
    """Energy of a state at rest that is no flock: the best lattice of n − 1 agents and one agent far away.

    ∞ where that lattice does not exist (κ too large) or n = 1.
    """
    if n < 2 or law.alpha.kappa >= (2.0 if m == 1 else sqrt(3.0)):
        return float("inf")
    bonds = n - 2 if m == 1 else harborth(n - 1)
    return law.gains.c1_alpha * law.alpha.far_potential * (n * (n - 1) // 2 - bonds)


def _stays_together(run: Trajectory) -> Hypothesis:
    """Ω_c speaks of every solution that starts in it: this run can break it, and so can a state that lies in it."""
    connectivity = run.metrics().connectivity.values
    worst = int(np.argmin(connectivity))
    name = "every solution from Ω_c is a cohesive dynamic flock"
    if connectivity[worst] < 1.0:
        detail = f"this run is no flock at t = {run.t[worst]:.4g}, where C = {connectivity[worst]:.3f}"
        return Hypothesis(name, "unmet", float(connectivity[worst]) - 1.0, detail)
    energy = run.law.structural_energy(run.q[0], run.p[0])
    apart = _disconnected_energy(run.law, run.n, run.m)
    if energy >= apart:
        detail = f"Ω_c holds a disconnected state at rest: its energy is {apart:.5g}, and c >= H(0) = {energy:.5g}"
        return Hypothesis(name, "unmet", apart - energy, detail)
    return Hypothesis(name, "assumed", detail="this run is connected at every sample; the others are not known")


def _below_c_star(run: Trajectory) -> Hypothesis:
    energy = run.law.structural_energy(run.q[0], run.p[0])
    c_star = run.law.gains.c1_alpha * run.law.alpha.c_star
    detail = f"H(0) = {energy:.5g}, c* = {c_star:.5g}"
    return Hypothesis("H(x(0), v(0)) < c*", "met" if energy < c_star else "unmet", c_star - energy, detail)


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) is Algorithm1
    law = Hypothesis("Algorithm 1 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim(name, "vacuous", detail="another law") for name in ("i", "ii", "iii", "iii-barrier")]
    together, energy = _stays_together(run), _below_c_star(run)
    barrier = below_the_barrier(run, run.law.structural_energy(run.q[0], run.p[0]))
    needs = [law, together]
    return [*needs, energy, barrier], [
        lattice_limit(run, needs, tolerances, name="i"),
        velocities_match(run, tolerances, needs, name="ii"),
        no_collision(run, [*needs, energy], tolerances, name="iii", proof=proved(run, "collisions")),
        no_collision(run, [*needs, barrier], tolerances, name="iii-barrier"),
    ]


THEOREM = Theorem(
    id="os-1",
    title="Algorithm 1: lattice, matched velocities, no collision",
    statement=(
        "If every solution that starts in the level set H(x, v) <= c is a cohesive dynamic flock, then (i) almost "
        "every solution converges to an equilibrium that is an α-lattice, (ii) velocities match in the moving frame, "
        "and (iii) if c < c* = ψ_α(0), no two agents ever collide."
    ),
    source="Olfati-Saber 2006, Theorem 1",
    kind="trajectory",
    check=_check,
)
