"""Scenarios of averaging over switching nets: with a common root, without one, with a leader, with growing windows."""

import numpy as np

from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.moreau_2005.laws import NetAveraging
from flockana.sources.moreau_2005.theorems import HALVES

_AGREES = verified("rooted-averaging", "rooted-averaging:hull") | vacuous("rooted-averaging:some-start")
_OPEN = vacuous("rooted-averaging:agreement") | verified("rooted-averaging:hull")
_NEVER = _OPEN | verified("rooted-averaging:some-start")


def _links(n: int, *heard: tuple[int, int]) -> np.ndarray:
    """Return the net in which agent i of each pair (i, j) averages with j at equal weights."""
    net = np.eye(n)
    for i, j in heard:
        net[i, [i, j]] = 0.5
    return net


def _net(name: str, title: str, law: NetAveraging, expected: dict[str, Status], steps: int) -> Builder:
    """Return the builder of a scenario of averaging agents, at random in a plane, or three on a line."""
    source_text = "Ours, on Moreau, and Ren and Beard: agents average in halves with those that they hear."

    def draw(seed: int) -> Start:
        n = len(law.nets[0])
        plane = np.random.default_rng(seed).uniform(-1.0, 1.0, (n, 2))
        q = np.array([[0.0], [0.0], [1.0]]) if any(law.growth) else plane
        return q, np.zeros_like(q)

    statuses = expected | (verified if any(law.growth) else vacuous)("growing-windows")
    return entry(name, title, source_text, law, draw, float(steps), statuses, references=("moreau-2005", "flockana"))


SCENARIOS = {
    "averaging-in-turn": _net(
        "averaging-in-turn",
        "One link of a ring of four at a time",
        NetAveraging([_links(4, (k, (k + 1) % 4)) for k in range(4)]),
        _AGREES,
        80,
    ),
    "averaging-leader": _net(
        "averaging-leader",
        "A leader that is heard by one agent now and then",
        NetAveraging([_links(4, (1, 0)), _links(4, (2, 1), (3, 2))], lengths=(1, 3)),
        _AGREES,
        80,
    ),
    "averaging-parted": _net(
        "averaging-parted",
        "Two pairs that never hear each other",
        NetAveraging([_links(4, (0, 1), (2, 3)), _links(4, (1, 0), (3, 2))]),
        _NEVER,
        40,
    ),
    "averaging-ever-later": _net(
        "averaging-ever-later",
        "Three agents in turn, in rounds that grow",
        NetAveraging(HALVES, lengths=(2, 1, 2, 1), growth=(1, 0, 1, 0)),
        _OPEN | vacuous("rooted-averaging:some-start"),
        200,
    ),
}
