"""Scenarios of cyclic pursuit: offset angles below, at and beyond 180°/n."""

import numpy as np

from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.pavone_frazzoli_2007.laws import CyclicPursuit

_ALL = verified("cyclic-pursuit", "cyclic-pursuit:motion")
_MEET = _ALL | verified("cyclic-pursuit:meet") | vacuous("cyclic-pursuit:circle", "cyclic-pursuit:spread")
_CIRCLE = _ALL | verified("cyclic-pursuit:circle") | vacuous("cyclic-pursuit:meet", "cyclic-pursuit:spread")
_SPREAD = _ALL | verified("cyclic-pursuit:spread") | vacuous("cyclic-pursuit:meet", "cyclic-pursuit:circle")


def _ring(name: str, title: str, n: int, angle: float, end: float, expected: dict[str, Status]) -> Builder:
    """Return the builder of a scenario of agents in cyclic pursuit with gain 1 from a random start."""
    law = CyclicPursuit(1.0, angle)
    source_text = f"Ours, on Pavone and Frazzoli: k = 1, θ = {angle:g}°, 180°/n = {180.0 / n:g}°; positions normal."

    def draw(seed: int) -> Start:
        q = np.random.default_rng(seed).normal(size=(n, 2))
        return law.start(0.0, q)

    return entry(name, title, source_text, law, draw, end, expected, references=("pavone-frazzoli-2007", "flockana"))


SCENARIOS = {
    "pursuit-meet": _ring("pursuit-meet", "Six agents pursue each other and meet", 6, 0.0, 20.0, _MEET),
    "pursuit-below": _ring("pursuit-below", "Four agents just below the critical angle", 4, 44.0, 40.0, _MEET),
    "pursuit-circle": _ring("pursuit-circle", "Four agents at the critical angle", 4, 45.0, 20.0, _CIRCLE),
    "pursuit-spread": _ring("pursuit-spread", "Four agents beyond the critical angle", 4, 50.0, 20.0, _SPREAD),
}
