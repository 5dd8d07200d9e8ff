"""Scenarios of pair laws from formulas: a following Morse flock, and a self-bound flock."""

from collections.abc import Callable

import numpy as np

from flockana.environment import LinearTarget
from flockana.interactions import FormulaInteraction, Gains, pair_law
from flockana.laws import Algorithm1, Algorithm2
from flockana.scenarios.scenario_builders import OURS, Scenario, vacuous, verified

_CLAIMS = ("cohesion", "velocities", "critical", "one-instant", "no-collision")
_VERIFIED = verified("any-potential") | verified(*(f"any-potential:{claim}" for claim in _CLAIMS))


def _morse() -> FormulaInteraction:
    """Return Morse's potential with its minimum near 7, brought to 0 at the range 14."""
    text = "k*((1 - exp(-a*(s - d)))**2 - 1)*(1 - s**2/r**2)**2"
    units = {"k": (2, -2), "a": (-1, 0)}
    return pair_law(
        text, adjacency="(1 - s/r)**2", range=14.0, length=7.0, parameters={"k": 30.0, "a": 0.5}, units=units
    )


def _follows(seed: int = 0) -> Scenario:
    """Return the scenario of twelve agents that follow a γ-agent, under Algorithm 2 with Morse's potential."""
    generator = np.random.default_rng(seed)
    grid = 8.0 * np.array([(i, j) for i in range(4) for j in range(3)], dtype=np.float64)
    title = "Twelve agents with Morse's potential follow a γ-agent"
    source_text = (
        "Ours: Algorithm 2 with a Morse potential of depth 30, a = 0.5, d = 7, brought to 0 at r = 14; a grid of "
        "spacing 8, each coordinate displaced by up to 1, velocities up to 1 per axis."
    )
    law = Algorithm2(_morse(), Gains(1.0, 1.0, 0.0, 0.0, 0.2, 0.5), LinearTarget((40.0, 0.0), (1.0, 0.0)))
    q, p = grid + generator.uniform(-1.0, 1.0, grid.shape), generator.uniform(-1.0, 1.0, grid.shape)
    expected = verified("energy") | _VERIFIED | vacuous("os-3") | verified("os-3:i", "os-3:iii")
    return Scenario("morse-follows", title, source_text, law, q, p, (0.0, 30.0), seed, expected, references=OURS)


def _holds(seed: int = 0) -> Scenario:
    """Return the scenario of four agents under Algorithm 1 with too little energy to separate."""
    generator = np.random.default_rng(seed)
    rhombus = 6.0 * np.array([(0.0, 0.0), (1.0, 0.0), (0.5, 0.75**0.5), (1.5, 0.75**0.5)])
    title = "Four agents with Morse's potential that have too little energy to part"
    source_text = (
        "Ours: Algorithm 1 with a Morse potential of depth 30, a = 0.5, d = 7, brought to 0 at r = 14; a rhombus of "
        "side 6, velocities up to 1 per axis. E(0) < 3 c1α (ψ(r) - L), so that no solution from there is disconnected."
    )
    law = Algorithm1(_morse(), Gains(1.0, 1.0))
    p = generator.uniform(-1.0, 1.0, rhombus.shape)
    expected = verified("energy") | _VERIFIED | vacuous("os-1") | verified("os-1:ii", "os-1:iii")
    return Scenario("morse-holds", title, source_text, law, rhombus, p, (0.0, 20.0), seed, expected, references=OURS)


SCENARIOS: dict[str, Callable[..., Scenario]] = {"morse-follows": _follows, "morse-holds": _holds}
