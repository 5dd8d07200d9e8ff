"""Erratum E2: the potential V_α of Algorithm 3 counts every pair once."""

from flockana.environment.obstacles import Sphere
from flockana.environment.targets import StaticTarget
from flockana.laws.algorithm3 import Algorithm3
from flockana.sources.geschwender_2016.theorems.claims_on_energy import PROOF, run_claim, state_claim
from flockana.sources.geschwender_2016.theorems.energy_printed import pair_energy
from flockana.theorems.theorem_toolkit import Claim, Tolerances, equal, erratum, observed


@erratum("E2", expected={"refuted": "printed printed-state printed-run", "verified": "corrected"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The slides print V_α = Σ_i Σ_(j≠i) ψ_α for Algorithm 3; its gradient is twice u^α. The factor is ½."""
    from flockana.symbolic.algorithm3_energy import e2_counterexample, e2_identity, theorem6_identity

    # two agents too close that approach further, a sphere beside them, the γ-agent at rest between them
    law = Algorithm3(target=StaticTarget((2.0, 0.0)), obstacles=(Sphere((2.0, 5.8), 2.0),))
    observation = observed(law, [[0.0, 0.0], [4.0, 0.0]], [[5.0, 0.0], [-5.0, 0.0]], (0.0, 1.0))
    stated_text = "dH/dt = -c2α pᵀL̂p + c2β ΣΣ b ⟨p, p̂ - p⟩ - c2γ Σ⟨p, p - p_r⟩"
    return [
        equal("printed", e2_identity(m=2).residual, disproof=PROOF).described(
            stated=f"{stated_text} for V_α = Σ_i Σ_(j≠i) ψ_α",
            detail="the printed V_α has twice the gradient that u^α uses: dV_α/dt remains, which has no definite sign",
        ),
        state_claim(e2_counterexample()),
        run_claim(observation, pair_energy, "two agents beside a sphere"),
        equal("corrected", theorem6_identity(m=2).residual, proof=PROOF).described(
            stated=f"{stated_text} for V_α = ½ Σ_i Σ_(j≠i) ψ_α",
            detail="with every pair once the identity is exact, for every n and any walls and spheres",
        ),
    ]
