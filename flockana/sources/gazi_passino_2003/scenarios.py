"""Scenarios of first-order swarms: repulsion below, at and above the attraction, and the extremal pair."""

from math import exp

import numpy as np

from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.gazi_passino_2003.laws import GaziPassino

_REFERENCES = ("gazi-passino-2003", "flockana")
_ALL = verified("gazi-passino", "gazi-passino:sharp", "gazi-passino:rate")
_COLLAPSE = _ALL | verified("gazi-passino:collapse") | vacuous("gazi-passino:apart")
_APART = _ALL | vacuous("gazi-passino:collapse") | verified("gazi-passino:apart")


def _swarm(name: str, title: str, n: int, repulsion: float, end: float, expected: dict[str, Status]) -> Builder:
    """Return the scenario builder of a swarm in the plane with a = 1 and c = 0.2, from a random start."""
    law = GaziPassino(1.0, repulsion, 0.2)
    source_text = (
        f"Ours: the law of Gazi and Passino, a = 1, b = {repulsion:.6g}, c = 0.2; positions uniform in a square of 6."
    )

    def draw(seed: int) -> Start:
        q = np.random.default_rng(seed).uniform(-3.0, 3.0, (n, 2))
        return law.start(0.0, q)

    return entry(name, title, source_text, law, draw, end, expected, references=_REFERENCES)


SCENARIOS = {
    "swarm": _swarm("swarm", "A swarm of nine that keeps apart", 9, 20.0, 10.0, _APART),
    "swarm-pair": _swarm("swarm-pair", "Two agents at the sharp bound, b = a√e", 2, exp(0.5), 10.0, _APART),
    "swarm-above": _swarm("swarm-above", "Repulsion just above attraction", 5, 1.05, 20.0, _APART),
    "swarm-equal": _swarm("swarm-equal", "Repulsion as strong as attraction", 5, 1.0, 20.0, _COLLAPSE),
    "swarm-collapse": _swarm("swarm-collapse", "Repulsion below attraction", 9, 0.9, 10.0, _COLLAPSE),
}
