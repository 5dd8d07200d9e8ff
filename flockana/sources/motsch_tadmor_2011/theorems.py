"""Motsch and Tadmor (2011): flocks of the normalised law, for velocity spreads below an integral of the influence."""

import numpy as np

from flockana.interactions.weights import RationalWeight
from flockana.sources.motsch_tadmor_2011.laws import MotschTadmor, diameters
from flockana.theorems.alignment_bounds import AlignmentRate, Guarantee
from flockana.theorems.bounds_between_samples import fastest_between
from flockana.theorems.theorem_toolkit import EPS, Checked, Enclosure, Observed, Tolerances, law_is, run_theorem

_PROOF = "own-sums"
_NAMES = ("bounded", "rate", "flock")


def _series(seen: Observed, of: str, error: np.ndarray) -> Enclosure:
    """Return the diameter of positions or velocities at each sample, widened by the errors of two agents."""
    values = [diameters(getattr(run, of)) for run in (seen.run, seen.other)]
    magnitude = np.abs(getattr(seen.run, of)).max(axis=(1, 2))
    return Enclosure.around(values[0], 2.0 * error.max(axis=1) + 8.0 * EPS * magnitude).clip(0.0)


def _checked(seen: Observed, power: float, name: str) -> Checked:
    """Return the hypothesis d_V(0) < α∫φ^k and claims from it, as velocities contract at αφ(d_X)."""
    law: MotschTadmor = seen.law
    rate = AlignmentRate(RationalWeight(1.0, power * law.weight.decay, law.weight.length), law.gain, 1.0)
    x, v = _series(seen, "q", seen.shape_error), _series(seen, "p", seen.speed_error)
    steps = np.diff(seen.t)
    step_distance = float((fastest_between(seen) * steps).max(initial=0.0))  # half an interval at twice the fastest
    widest = Enclosure(float(x.lo.max()), float(x.mid.max()), float(x.hi.max()) + step_distance)
    guarantee = Guarantee(seen, rate, x, widest, v, _PROOF, ("d_X{}", "d_V{}"))
    return guarantee.claims([guarantee.hypothesis(name)], limit="flock")


@run_theorem(
    "motsch-tadmor",
    title="Influences relative to each agent's own sum make a flock, if velocities differ little",
    source="Motsch and Tadmor 2011, in our words",
    law=law_is("the law of Motsch and Tadmor", MotschTadmor),
    claims=_NAMES,
    references=("motsch-tadmor-2011",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let u_i = α Σ_j a_ij (p_j - p_i), a_ij = φ(‖q_j - q_i‖)/Σ_k φ(‖q_k - q_i‖), the sum with i itself, φ falling from
    1, and d_X, d_V the largest distances of positions and velocities. If d_V(0) < α ∫φ² from d_X(0) on, then d_X stays
    below the x_M up to which α ∫φ² is d_V(0), and d_V <= d_V(0) exp(-αφ²(x_M) t).
    """
    return _checked(seen, 2.0, "d_V(0) < α∫φ² from d_X(0) on")


@run_theorem(
    "motsch-tadmor-sharp",
    title="The same below the integral of the influence itself",
    source="Ours, on Motsch and Tadmor 2011",
    law=law_is("the law of Motsch and Tadmor", MotschTadmor),
    claims=_NAMES,
    references=("motsch-tadmor-2011", "flockana"),
    author="flockana",
)
def sharp(seen: Observed, tolerances: Tolerances) -> Checked:
    """As the theorem of Motsch and Tadmor, with φ in place of φ²: each a_ij is at least φ(d_X)/n, so that two rows have
    at least φ(d_X) in common, and the diameter of the velocities contracts at αφ(d_X). Not sharp for two agents, which
    flock below α∫2φ/(1 + φ).
    """
    return _checked(seen, 1.0, "d_V(0) < α∫φ from d_X(0) on")
