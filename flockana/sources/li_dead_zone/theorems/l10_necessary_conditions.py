"""Erratum L10: necessary and sufficient conditions, announced in the conclusion and never stated."""

import numpy as np

from flockana.measures.metrics import min_distance
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.theorems.common_claims import final_components
from flockana.sources.li_dead_zone.theorems.net_components import Component
from flockana.sources.li_dead_zone.theorems.shared_runs import parting_pair
from flockana.theorems.claims import erratum, exact, undecided
from flockana.theorems.theorem_toolkit import EPS, Certificate, Claim, FloatArray, Tolerances, limit_claim, observed

_TIMES = 2.0  # as much energy as can put the pair out of range


def escaping_pair() -> tuple[DeadZoneFlocking, FloatArray, FloatArray]:
    """Return two agents in contact that separate with twice the escape energy under strong damping."""
    law = DeadZoneFlocking(DeadZoneInteraction(), k2=10.0)
    q = np.array([[0.0, 0.0], [law.interaction.d1, 0.0]])
    rest_energy = law.hamiltonian(0.0, q, np.zeros_like(q))
    speed = float(np.sqrt(_TIMES * law.interaction.far_potential - rest_energy))  # each: H = 2 · ½ v² + rest
    return law, q, np.array([[-speed, 0.0], [speed, 0.0]])


def energy_share(law: DeadZoneFlocking, q: FloatArray, p: FloatArray) -> float:
    """Return the energy H̄ divided by (n − 1) ψ̄(r); below 1, a connected flock stays connected."""
    return law.hamiltonian(0.0, q, p) / ((len(q) - 1) * law.interaction.far_potential)


def _is_finite_apart() -> bool | None:
    """Return whether the pair potential is finite at every distance > 0, so that every start has a finite energy."""
    # None if sympy cannot tell.
    import sympy as sp

    from flockana.sources.li_dead_zone.symbolic import ETA_POSITIVE, K_DELTA, K_R, repulsive_primitive

    s = sp.Symbol("s", positive=True)
    values = [repulsive_primitive(s, eta=eta).subs({K_R: 1, K_DELTA: 1}) for eta in (ETA_POSITIVE, sp.Integer(0))]
    is_finite = [value.is_finite for value in values]
    return None if None in is_finite else all(is_finite)


def _necessary() -> Claim:
    """Return the claim that the paper's stated condition excludes some start, decided by algebra."""
    is_finite, stated = _is_finite_apart(), "the condition leaves some start out"
    if is_finite is None:
        return undecided("printed-necessary", "sympy cannot decide whether the potential is finite", stated=stated)
    detail = (
        "a pair's potential is finite at every distance > 0: every start from distinct positions meets the stated "
        "condition, which as a necessary one excludes nothing; no other is stated"
    )
    return exact("printed-necessary", not is_finite, stated=stated, detail=detail)


@erratum(
    "L10",
    expected={"refuted": "printed-sufficient printed-necessary", "verified": "sufficient not-necessary"},
    ours=("sufficient", "not-necessary"),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The conclusion claims necessary and sufficient conditions for the particular case. The paper states one
    condition, in Theorem 1: velocity mismatch, inertias and energy are limited. It does not suffice, and every start
    from distinct places meets it. H̄(0) < (n - 1) ψ̄(r) suffices for a connected flock, and is not necessary.
    """
    # Check the paper's condition on a pair that separates, and an energy condition: sufficient, not necessary.
    law, q, p = parting_pair()
    components = final_components(observed(law, q, p, (0.0, 10.0)), law)
    wild_law, x, v = escaping_pair()
    share = energy_share(wild_law, x, v)
    later_run = observed(wild_law, x, v, (0.0, 10.0))
    bond = final_components(later_run, wild_law).members[0].bond
    left = bond.text.replace("its energy", "the energy left")
    calm_component = Component(law, x, 0.1 * v)
    return [
        limit_claim("printed-sufficient", [], escape=components.separation).described(
            stated="limited mismatch, inertia and energy H0 suffice for Theorem 1",
            detail=f"two agents satisfy the conditions at H0 = {law.hamiltonian(0.0, q, p):.4g}, and separate: they "
            "neither stay together nor match velocities (L4, L7)",
        ),
        _necessary(),
        limit_claim("sufficient", [], [calm_component.bond], computed=energy_share(law, x, 0.1 * v)).described(
            stated="a condition that suffices: a connected flock with H̄ < (n - 1) ψ̄(r) stays connected and matches",
            detail=f"two agents in contact that leave at {0.2 * v[1, 0]:.3g} m/s",
        ),
        limit_claim(
            "not-necessary", [], [Certificate(min(share - 1.0, bond.margin), left, bond.error + 64.0 * EPS)]
        ).described(
            computed=share,
            stated="the condition is not necessary: a flock with more energy may stay together",
            detail=f"two agents with H̄ = {share:.4g} ψ̄(r) leave at {2.0 * v[1, 0]:.3g} m/s, k₂ = 10; at t = 10 "
            f"they are {min_distance(later_run.end.q):.3g} apart",
        ),
    ]
