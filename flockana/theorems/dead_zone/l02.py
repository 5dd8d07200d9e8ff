"""Erratum L2: with n = q_i - q_j, as (8) has it, repulsion becomes attraction, and two agents meet in finite time."""

from __future__ import annotations

from math import sqrt

from flockana.interactions.dead_zone import DeadZoneInteraction
from flockana.theorems.dead_zone.case import PROOF
from flockana.theorems.dead_zone.erratum import CheckResult, erratum, margin_claim
from flockana.theorems.theorem import Tolerances

_ROUNDING = 1e-12  # relative, of a force of two agents


def _check(tolerances: Tolerances) -> CheckResult:
    """The force on two agents nearer than d1 with either direction of n, and when they meet under the printed one."""
    from scipy.integrate import quad

    pair, start = DeadZoneInteraction(k1=0.0), 3.0
    attraction = float(pair.force(start)) / pair.contact_force
    level = float(pair.psi(start))
    # two agents at rest under −F: ½ρ'² = 2(ψ(ρ) − ψ(3)), and with ρ = 3(1 − x²) the integrand is smooth at the start
    fall = quad(lambda x: 3.0 * x / sqrt(pair.psi(start * (1.0 - x * x)) - level), 0.0, 1.0, limit=200)[0]
    return [], [
        margin_claim(
            "printed",
            attraction,
            f"with n = q_i - q_j two agents at rest {start:g} apart, nearer than d1, are drawn together and meet after "
            f"{fall:.4g}",
            error=_ROUNDING,
            computed=fall,
            stated="repulsion below r_b - δ",
            proof=PROOF,
        ),
        margin_claim(
            "corrected",
            -attraction,
            f"with n = q_j - q_i their force is {attraction:.4g} of that of a contact: it repels",
            error=_ROUNDING,
        ),
    ]


THEOREM = erratum(
    2,
    "n points from i to j",
    "Three conventions for n are given; with q_i - q_j repulsion and attraction change places and agents fall into "
    "each other. q_j - q_i is meant throughout.",
    "(6)-(8)",
    _check,
    whole="refuted",
    printed="refuted",
    corrected="verified",
)
