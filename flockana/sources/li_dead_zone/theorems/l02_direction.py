"""Erratum L2: with n = q_i - q_j, as in (8), repulsion becomes attraction, and agents meet in finite time."""

from math import sqrt

from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.theorems.common_claims import PROOF
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, of_state

_ROUNDING = 1e-12  # relative, of a force of two agents


@erratum("L2")
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Three conventions for n are given; with q_i - q_j repulsion and attraction change places and agents fall into
    each other. The paper presumably means q_j - q_i throughout.
    """
    # The force on two agents nearer than d1 with either direction of n, and when they meet under the printed one.
    from scipy.integrate import quad

    pair, start = DeadZoneInteraction(k1=0.0), 3.0
    attraction = -float(pair.force(start)) / pair.contact_force
    level = float(pair.energy(start))
    # two agents at rest under −F: ½ρ'² = 2(ψ(ρ) − ψ(3)), and with ρ = 3(1 − x²) the integrand is smooth at the start
    fall_time = quad(lambda x: 3.0 * x / sqrt(pair.energy(start * (1.0 - x * x)) - level), 0.0, 1.0, limit=200)[0]
    return [
        of_state("printed", attraction, _ROUNDING, about="all", disproof=PROOF, computed=fall_time).described(
            stated="repulsion below r_b - δ",
            detail=f"with n = q_i - q_j two agents at rest {start:g} apart, nearer than d1, are drawn together and "
            f"meet after {fall_time:.4g}",
        ),
        of_state("corrected", -attraction, _ROUNDING).described(
            detail=f"with n = q_j - q_i the same agents' force is {attraction:.4g} of that of a contact: it repels"
        ),
    ]
