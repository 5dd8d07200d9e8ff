"""Scenarios of finite-time agreement: a ring; for contrast a linear law and a disconnected net."""

import numpy as np

from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.wang_xiao_2010.laws import FiniteTimeAlignment


def _net(name: str, title: str, law: FiniteTimeAlignment, n: int, end: float, expected: dict[str, Status]) -> Builder:
    """Return the builder of a scenario of agents on a given net with a random start."""
    source = f"Ours, on Wang and Xiao: u_i = Σ_j sig(p_j - p_i)^α over links, α = {law.exponent:g}; a random start."

    def draw(seed: int) -> Start:
        generator = np.random.default_rng(seed)
        return generator.uniform(-1.0, 1.0, (n, 2)), generator.uniform(-1.0, 1.0, (n, 2))

    return entry(name, title, source, law, draw, end, expected, references=("wang-xiao-2010", "flockana"))


_RING = tuple((k, (k + 1) % 5) for k in range(5))
_SETTLES = verified("finite-time", "finite-time:bound", "finite-time:settle") | vacuous("finite-time:some-start")
_NEVER = vacuous("finite-time", "finite-time:bound", "finite-time:settle") | verified("finite-time:some-start")
SCENARIOS = {
    "finite-time-ring": _net(
        "finite-time-ring", "A ring of five that agrees in a finite time", FiniteTimeAlignment(_RING), 5, 0.8, _SETTLES
    ),
    "finite-time-linear": _net(
        "finite-time-linear", "A ring of five at α = 1", FiniteTimeAlignment(_RING, exponent=1.0), 5, 10.0, _NEVER
    ),
    "finite-time-parted": _net(
        "finite-time-parted", "Two pairs without a link", FiniteTimeAlignment(((0, 1), (2, 3))), 4, 0.5, _NEVER
    ),
}
