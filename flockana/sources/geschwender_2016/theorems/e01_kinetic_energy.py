"""Erratum E1: the Hamiltonian needs the factor ½ before Σ‖p_i‖²."""

import numpy as np

from flockana.laws.olfati_saber import Algorithm1
from flockana.sources.geschwender_2016.theorems.claims_on_energy import PROOF, run_claim, state_claim
from flockana.theorems.theorem_toolkit import Claim, Tolerances, equal, erratum, observed


@erratum("E1", expected={"refuted": "printed printed-state printed-run", "verified": "corrected"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The slides print H = V + Σ‖p_i‖² and take its derivative to be -pᵀL̂p; that needs the factor ½."""
    from flockana.symbolic import algorithm1_identity, e1_counterexample, e1_identity

    falling_pair = observed(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 2.0))  # and the printed energy climbs
    return [
        equal("printed", e1_identity(m=2).residual, disproof=PROOF, stated="d/dt (V + Σ‖p_i‖²) = -c2α pᵀL̂p").described(
            detail="with the printed H a term -dV/dt remains, which has no definite sign"
        ),
        state_claim(e1_counterexample()),
        run_claim(falling_pair, lambda run: 0.5 * np.sum(run.p**2, axis=(1, 2)), "two agents"),
        equal("corrected", algorithm1_identity(m=2).residual, proof=PROOF).described(
            stated="d/dt (V + ½ Σ‖p_i‖²) = -c2α pᵀL̂p", detail="with ½ the identity is exact, for every n"
        ),
    ]
