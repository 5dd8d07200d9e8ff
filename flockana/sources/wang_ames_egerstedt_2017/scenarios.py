"""Scenarios of the safety filter: a pair and five agents pulled together, and a pair too fast to brake."""

import numpy as np

from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.wang_ames_egerstedt_2017.laws import SafetyFilter
from flockana.sources.yu_chen_cao_2010 import NetConsensus

_SAFE = verified("safety-filter", "safety-filter:apart", "safety-filter:braking") | vacuous("safety-filter:too-late")
_LATE = vacuous("safety-filter", "safety-filter:apart", "safety-filter:braking") | verified("safety-filter:too-late")


def _pulled(name: str, title: str, start: Start, expected: dict[str, Status], end: float = 8.0) -> Builder:
    """Return the builder of a scenario of agents drawn together on a complete net under the safety filter."""
    n = len(start[0])
    law = SafetyFilter(NetConsensus(np.ones((n, n)) - np.eye(n), 0.3, 0.3), distance=1.0)
    source = "Ours, on Wang, Ames and Egerstedt: consensus of positions, kept apart by the filter; D = α = γ = 1."
    return entry(
        name, title, source, law, lambda _: start, end, expected, references=("wang-ames-egerstedt-2017", "flockana")
    )


_PAIR = np.array([[-2.0, 0.0], [2.0, 0.1]]), np.array([[0.8, 0.0], [-0.8, 0.0]])
_FIVE = 3.0 * np.array([[np.cos(a), np.sin(a)] for a in 0.4 * np.pi * np.arange(5)])
SCENARIOS = {
    "safety-head-on": _pulled("safety-head-on", "Two agents head on, kept apart", _PAIR, _SAFE),
    "safety-swarm": _pulled("safety-swarm", "Five agents drawn to one place, kept apart", (_FIVE, -0.2 * _FIVE), _SAFE),
    "safety-too-late": _pulled(
        "safety-too-late",
        "Two agents that can no longer brake",
        (np.array([[0.0], [2.0]]), np.array([[1.5], [-1.5]])),
        _LATE,
        0.3,
    ),
}
