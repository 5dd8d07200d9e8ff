"""Erratum L3: φ_z, called a bounded potential, is a force that is unbounded as 1/ρ² where agents meet."""

from flockana.sources.li_dead_zone.theorems.common_claims import PROOF
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, exact


@erratum("L3")
def theorem(tolerances: Tolerances) -> list[Claim]:
    """φ_z is called a bounded potential. It is a force, unbounded as 1/r²; its potential is unbounded too, but only
    logarithmically, because n ~ ρ.
    """
    # φ_z grows as 1/ρ² and its potential as −ln ρ where two agents meet: by algebra.
    import sympy as sp

    from flockana.sources.li_dead_zone.symbolic import K_R, RHO, derive_potential, repulsion

    growth = sp.limit(RHO**2 * repulsion(), RHO, 0, "+")
    potential = derive_potential()
    return [
        exact("printed", growth != 2 * K_R, disproof=PROOF, computed=str(growth)).described(
            stated="φ_z is a bounded, positive definite potential",
            witness="limit of ρ² |f| at 0",
            detail="φ_z is a force, and ρ²|φ_z| tends to 2 k_r at 0: it is unbounded",
        ),
        exact("corrected", potential.holds, proof=PROOF).described(
            computed=[str(residual) for residual in potential.residuals],
            stated="dψ/dρ = F, and ψ/(-2k_r ln ρ) -> 1",
            detail="the potential in closed form, for η > 0 and η = 0, grows only logarithmically at 0, as n ~ ρ",
        ),
    ]
