"""Scenarios of normalised influences: pairs on both sides of three thresholds, a small group near a large one."""

import numpy as np

from flockana.interactions.weights import RationalWeight
from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.motsch_tadmor_2011.laws import MotschTadmor

_REFERENCES = ("motsch-tadmor-2011", "flockana")


def _pair(name: str, speed: float, expected: dict[str, Status]) -> Builder:
    """Return two agents on a line, 1 apart, that separate."""
    source_text = (
        "Ours: two agents on a line, 1 apart, under the law of Motsch and Tadmor, φ = 1/(1 + s²), α = 1, relative "
        f"speed {speed:g}. From 1 on ∫φ² = 0.1427, ∫φ = π/4, and ∫2φ/(1 + φ) = √2 (π/2 − atan(1/√2)) = 1.3510, beyond "
        "which they part for ever. The start is fixed."
    )
    start = np.array([[0.0], [1.0]]), np.array([[0.0], [speed]])
    law = MotschTadmor(RationalWeight(decay=1.0))
    title = f"Two agents with own sums that part at {speed:g}"
    return entry(name, title, source_text, law, lambda seed: start, 20.0, expected, references=_REFERENCES)


def _two_groups(seed: int) -> Start:
    """Return four agents close together, and sixteen a little away."""
    rng = np.random.default_rng(seed)
    q, p = rng.uniform(-0.1, 0.1, (20, 2)), rng.uniform(-0.05, 0.05, (20, 2))
    q[4:, 0] += 0.6
    return q, p + np.array([1.0, 0.5])


_BOTH = verified("motsch-tadmor", "motsch-tadmor-sharp")
_NEITHER = vacuous("motsch-tadmor", "motsch-tadmor-sharp")
SCENARIOS = {
    "own-sums-near": _pair("own-sums-near", 0.13, _BOTH),
    "own-sums-between": _pair("own-sums-between", 0.7, vacuous("motsch-tadmor") | verified("motsch-tadmor-sharp")),
    "own-sums-fast": _pair("own-sums-fast", 1.4, _NEITHER),
    "own-sums-flock": entry(
        "own-sums-flock",
        "Four agents beside sixteen, with own sums",
        "Ours: the law of Motsch and Tadmor, φ = (1 + s²)^−½, α = 1; a small group beside a large one, velocities "
        "uniform in a square of side 0.1 about (1, 0.5).",
        MotschTadmor(RationalWeight(decay=0.5)),
        _two_groups,
        10.0,
        _BOTH,
        references=_REFERENCES,
    ),
}
