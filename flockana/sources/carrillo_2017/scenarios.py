"""Scenarios of a singular alignment weight: pairs at and near the contact speed, and flocks without contact."""

import numpy as np

from flockana.interactions.weights import SingularWeight
from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.carrillo_2017.laws import SingularAlignment

_REFERENCES = ("carrillo-2017", "ahn-2012", "flockana")


def _pair(name: str, decay: float, speed: float, end: float, expected: dict[str, Status]) -> Builder:
    """Return the scenario builder of two agents on a line, 1 apart, that approach each other."""
    title = f"Two agents that approach at {speed:g} under the weight s^-{decay:g}"
    source_text = (
        f"Ours: two agents on a line, 1 apart, relative speed {speed:g}, K = ℓ = 1. For α = ½ they meet if it is 4 or "
        "more. The start is fixed."
    )
    start = np.array([[0.0], [1.0]]), np.array([[0.0], [-speed]])
    law = SingularAlignment(SingularWeight(decay=decay))
    return entry(name, title, source_text, law, lambda seed: start, end, expected, references=_REFERENCES)


def _crowd(seed: int) -> Start:
    """Return positions and velocities of nine agents near a grid that fly towards its middle."""
    rng = np.random.default_rng(seed)
    q = np.stack(np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]), axis=-1).reshape(9, 2)
    return q + rng.uniform(-0.1, 0.1, (9, 2)), -4.0 * q


_WEAK = vacuous("singular-alignment", "singular-alignment:apart") | verified("singular-alignment:some-start")
_MEET = _WEAK | verified("singular-pair", "singular-pair:meet") | vacuous("singular-pair:apart")
_APART = _WEAK | verified("singular-pair", "singular-pair:apart") | vacuous("singular-pair:meet")
_STRONG = verified("singular-alignment", "singular-alignment:apart") | vacuous("singular-alignment:some-start")
SCENARIOS = {
    "singular-slow": _pair("singular-slow", 0.5, 3.9, 2.0, _APART),
    "singular-critical": _pair("singular-critical", 0.5, 4.0, 0.45, _MEET),
    "singular-fast": _pair("singular-fast", 0.5, 5.0, 0.25, _MEET),
    "singular-never": _pair("singular-never", 1.0, 5.0, 2.0, _STRONG | vacuous("singular-pair")),
    "singular-crowd": entry(
        "singular-crowd",
        "Nine agents that fly towards one place under the weight 1/s",
        "Ours: a grid of nine agents, each displaced by up to 0.1, velocities -4 times its place, K = ℓ = α = 1.",
        SingularAlignment(),
        _crowd,
        2.0,
        _STRONG,
        references=("carrillo-2017", "flockana"),
    ),
}
