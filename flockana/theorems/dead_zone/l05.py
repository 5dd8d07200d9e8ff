"""Erratum L5: energy summed over neighbours jumps as a pair comes into range; the saturated energy does not."""

from __future__ import annotations

import numpy as np

from flockana.dynamics.simulate import simulate
from flockana.interactions.dead_zone import DeadZoneInteraction
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.theorems.claims import erratum, exact, of_state
from flockana.theorems.dead_zone.case import PROOF
from flockana.theorems.theorem import Claim, Tolerances

_ROUNDING = 1e-11  # relative: of an energy balance's sums


def _check(tolerances: Tolerances) -> list[Claim]:
    """The energy of neighbours and the saturated energy along a run in which two agents come into range."""
    from flockana.symbolic.dead_zone import saturated_energy_identity

    law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0))  # so that the switch is located
    run = simulate(law, [[0.0, 0.0], [16.0, 0.0]], [[1.0, 0.0], [-1.0, 0.0]], (0.0, 2.0))
    of_neighbours = np.array([law.literal_energy(q, p) for q, p in zip(run.q, run.p, strict=True)])
    rise, error = float(np.diff(of_neighbours).max()), float(np.abs(run.energy_residual).max())
    far = law.interaction.far_potential
    identities = [saturated_energy_identity(m) for m in (1, 2, 3)]
    return [
        of_state(
            "printed",
            -rise / far,
            10.0 * error / far,
            computed=rise,
            stated="H never rises",
            proof=PROOF,
            detail=f"as two agents come into range, H of neighbours rises by {rise:.4g}, and ψ(r) = {far:.4g}",
        ),
        exact(
            "corrected",
            all(derivation.holds for derivation in identities),
            stated="dH̄/dt = -k₂ pᵀL̂p",
            witness=[str(derivation.residuals) for derivation in identities],
            proof=PROOF,
            detail="the identity holds for a generic pair, so for every n, in 1, 2 and 3 dimensions",
        ),
        of_state(
            "across-the-switch",
            1.0 - error / (tolerances.energy * float(run.energy()[0])),
            _ROUNDING / tolerances.energy,
            detail=f"along the same run the balance of the saturated energy is off by {error:.2g}",
        ),
    ]


THEOREM = erratum(
    "L5",
    title="The energy of neighbours jumps",
    statement=(
        "H summed over neighbours jumps up by ψ(r) whenever a pair comes into range. With the potential saturated at "
        "r, dH̄/dt = -k₂ pᵀL̂p across all switches."
    ),
    source="Li, Yuan and Liu, Theorem 1, energy",
    check=_check,
    references=("li-dead-zone",),
    expected={"printed": "refuted", "corrected": "verified", "across-the-switch": "verified"},
)
