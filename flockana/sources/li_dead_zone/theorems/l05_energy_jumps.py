"""Erratum L5: energy summed over neighbours jumps as a pair comes into range; the saturated energy does not."""

import numpy as np

from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.theorems.common_claims import PROOF
from flockana.theorems.energy import balance
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, exact, judged, observed


@erratum(
    "L5",
    expected={"refuted": "printed", "verified": "corrected across-the-switch"},
    corrected=("corrected", "across-the-switch"),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """H summed over neighbours jumps up by ψ(r) whenever a pair comes into range. With the potential saturated at r,
    dH̄/dt = -k₂ pᵀL̂p across all switches.
    """
    # The energy of neighbours and the saturated energy along a run in which two agents come into range.
    from flockana.sources.li_dead_zone.symbolic import saturated_energy_identity

    law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0))  # so that the switch is located
    observation = observed(law, [[0.0, 0.0], [16.0, 0.0]], [[1.0, 0.0], [-1.0, 0.0]], (0.0, 2.0))
    far_energy = law.interaction.far_potential
    energy = observation.series(lambda run: list(map(law.literal_energy, run.q, run.p)), floor=observation.floors.work)
    rise = float(np.diff(energy.mid).max())
    identities = [saturated_energy_identity(m) for m in (1, 2, 3)]
    return [
        judged("printed", (energy[:-1] - energy[1:]) / far_energy, disproof=PROOF, computed=rise).described(
            stated="H never rises",
            detail=f"as two agents come into range, H of neighbours rises by {rise:.4g}, and ψ(r) = {far_energy:.4g}",
        ),
        exact("corrected", all(derivation.holds for derivation in identities), proof=PROOF).described(
            stated="dH̄/dt = -k₂ pᵀL̂p",
            witness=[str(derivation.residuals) for derivation in identities],
            detail="the identity holds for a generic pair, so for every n, in 1, 2 and 3 dimensions",
        ),
        balance(observation, [], tolerances, name="across-the-switch"),
    ]
