"""Scenarios of the Cucker-Smale law: flocking by velocity consensus, and pairs at the critical speed."""

import numpy as np

from flockana.interactions.weights import RationalWeight
from flockana.scenarios.one_start import RANGE, LawEntry
from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.cucker_smale_2007.laws import CuckerSmale

_REFERENCES = ("cucker-smale-2007", "ha-liu-2009", "flockana")
_N = 12


def _flock(name: str, beta: float, speed: float, expected: dict[str, Status]) -> Builder:
    """Return the scenario builder of twelve agents in the plane with random velocities of a given spread."""
    title = f"Twelve agents that match velocities alone, β = {beta:g}"
    source_text = (
        f"Ours: the law of Cucker and Smale in the form of Ha and Liu, K = 2, ℓ = 1, β = {beta:g}; positions "
        f"uniform in a square of side 0.8, velocities uniform, then scaled to Σ‖p_i − p_c‖² = {speed:g}²."
    )
    law = CuckerSmale(RationalWeight(strength=2.0, decay=beta), mean=True)

    def draw(seed: int) -> Start:
        generator = np.random.default_rng(seed)
        q, p = generator.uniform(-0.4, 0.4, (_N, 2)), generator.uniform(-1.0, 1.0, (_N, 2))
        p -= p.mean(axis=0)
        return q, p * (speed / np.sqrt(np.sum(p * p))) + (1.0, 0.5)

    return entry(name, title, source_text, law, draw, 4.0, expected, references=_REFERENCES)


def _pair(name: str, speed: float, expected: dict[str, Status]) -> Builder:
    """Return the scenario builder of two agents on a line that separate; the critical speed is π/4."""
    title = f"Two agents that separate at {speed:g}; the critical speed is π/4"
    source_text = (
        "Ours: two agents on a line, 1 apart, the law of Cucker and Smale in the form of Ha and Liu, "
        f"K = ℓ = β = 1, relative speed {speed:g}. ∫ds/(1 + s²) from 1 on is π/4. The start is fixed."
    )
    law = CuckerSmale(RationalWeight(strength=1.0, decay=1.0), mean=True)
    start = np.array([[0.0], [1.0]]), np.array([[0.0], [speed]])
    return entry(name, title, source_text, law, lambda seed: start, 20.0, expected, references=_REFERENCES)


_ALL = verified("ha-liu", "ha-liu-sharp")
_BELOW = vacuous("ha-liu") | verified("ha-liu-sharp", "cucker-smale-pair", "cucker-smale-pair:bounded")
_BELOW |= vacuous("cucker-smale-pair:parts")
_ABOVE = vacuous("ha-liu", "ha-liu-sharp", "cucker-smale-pair:bounded")
_ABOVE |= verified("cucker-smale-pair", "cucker-smale-pair:parts")
SCENARIOS = {
    "cucker-smale": _flock("cucker-smale", 0.25, 8.0, verified("cucker-smale") | _ALL),
    "cucker-smale-steep": _flock("cucker-smale-steep", 1.0, 0.1, vacuous("cucker-smale") | _ALL),
    "cucker-smale-critical-below": _pair("cucker-smale-critical-below", 0.76, _BELOW),
    "cucker-smale-critical-above": _pair("cucker-smale-critical-above", 0.81, _ABOVE),
}


ONE_START = (
    LawEntry(
        "Cucker and Smale",
        lambda q, p: CuckerSmale(RationalWeight(strength=0.5, decay=0.25, length=RANGE)),
        "cucker-smale",
        "every agent aligns with all others, with a weight that falls slowly (β < ½): a flock from any start",
    ),
    LawEntry(
        "Ha and Liu",
        lambda q, p: CuckerSmale(RationalWeight(strength=4.0, decay=1.0, length=RANGE), mean=True),
        "ha-liu",
        "the weight falls fast (β > ½): a flock if the spread of velocities is below an integral of it",
    ),
)
