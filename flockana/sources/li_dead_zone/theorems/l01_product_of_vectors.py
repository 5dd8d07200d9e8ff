"""Erratum L1: (7) and (9) multiply two vectors; a componentwise product depends on the axes."""

from typing import Any

import numpy as np

from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, erratum, lengths, of_state

_SAME = 1e-9  # relative: two forces that differ by less are the same
_ROUNDING = 1e-12  # relative, of a force of three agents: some hundred roundings


@erratum("L1")
def theorem(tolerances: Tolerances) -> list[Claim]:
    """(7) already sums over neighbours and carries the direction; (9) multiplies by n_ij and sums again. A product of
    two vectors is undefined; by components it depends on the axes. The paper presumably means the scalar force once and
    n once.
    """
    # The forces on three agents before and after the axes are turned, as printed and as corrected.
    pair = DeadZoneInteraction(k1=0.0)
    q = np.array([[0.0, 0.0], [2.0, 0.5], [-1.0, 2.5]])
    rotation = np.array([[0.6, -0.8], [0.8, 0.6]])

    def printed(x: FloatArray) -> FloatArray:
        """Return u_i = Σ_j φ_zi ∘ n_ij with φ_zi = Σ_j f_ij n_ij, the only product of (7) and (9) that is a vector."""
        delta = x[None] - x[:, None]
        rho = lengths(delta)
        n = delta / np.sqrt(1.0 + pair.eta * rho**2)[:, :, None]
        f = np.where(rho > 0.0, pair.action(np.where(rho > 0.0, rho, 8.0)), 0.0)
        return np.einsum("ij,ijc->ic", f, n) * n.sum(axis=1)

    law = DeadZoneFlocking(pair)

    def corrected(x: FloatArray) -> FloatArray:
        return law.acceleration(0.0, x, np.zeros_like(x))

    def change_by_turning(u: Any) -> float:
        """Return the largest change of a force by a rotation, relative to the largest force."""
        return float(np.abs(u(q @ rotation.T) - u(q) @ rotation.T).max() / np.abs(u(q)).max())

    printed_change, corrected_change = change_by_turning(printed), change_by_turning(corrected)
    return [
        of_state("printed", _SAME - printed_change, _ROUNDING, about="all", disproof="turned-axes").described(
            detail=f"as a product by components: turning the axes changes the force by {printed_change:.3g} of itself"
        ),
        of_state("corrected", _SAME - corrected_change, _ROUNDING, about="all", proof="turned-axes").described(
            detail=f"with f once and n once the force turns with the axes, to {corrected_change:.2g}"
        ),
    ]
