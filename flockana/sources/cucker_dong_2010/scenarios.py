"""Scenarios of collision avoidance: approaching agents, with and without repulsion."""

import numpy as np

from flockana.interactions.weights import RationalWeight
from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.cucker_dong_2010.laws import CuckerDong

_NAMES = ("cucker-dong", *(f"cucker-dong:{claim}" for claim in ("functional", "apart", "bounded", "flock")))


def _crossing(name: str, title: str, repulsion: float, expected: dict[str, Status]) -> Builder:
    """Return the scenario builder of two rows of three agents that fly at each other."""
    source_text = f"Ours: two rows of three agents that fly at each other, K = ℓ = 1, β = ¼, δ = ½, k = {repulsion:g}."

    def draw(seed: int) -> Start:
        rng = np.random.default_rng(seed)
        q = np.array([[x, y] for x in (-2.0, 2.0) for y in (-1.5, 0.0, 1.5)])
        return q + rng.uniform(-0.1, 0.1, q.shape), np.sign(q[:, :1]) * [-3.0, 0.0]

    law = CuckerDong(RationalWeight(decay=0.25), repulsion, 0.5)
    return entry(name, title, source_text, law, draw, 3.0, expected, references=("cucker-dong-2010", "flockana"))


SCENARIOS = {
    "avoiding": _crossing("avoiding", "Two rows that fly at each other and keep apart", 1.0, verified(*_NAMES)),
    "avoiding-none": _crossing("avoiding-none", "The same rows without a repulsion", 0.0, vacuous(*_NAMES)),
}
