"""Functional ‖v‖ + ∫φ of Ha and Liu on a run of the Cucker-Smale law, continuous or discrete."""

from flockana.theorems.alignment_bounds import AlignmentRate, Guarantee
from flockana.theorems.bounds_between_samples import spread_over
from flockana.theorems.theorem_toolkit import Observed

PROOF = "cucker-smale"


def guarantee_of(seen: Observed, stretch: float) -> Guarantee:
    """Return the flocking guarantee of the functional ‖v‖ + ∫φ: λ = K in φ for sums divided by n, else nK."""
    law = seen.law.continuous
    phi = AlignmentRate(law.weight, law.weight.strength * (1.0 if law.mean else seen.n), stretch)
    return Guarantee(seen, phi, seen.spread, spread_over(seen).max(), seen.velocity_spread, PROOF)
