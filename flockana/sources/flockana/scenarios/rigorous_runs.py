"""Scenarios with rigorous verdicts: a flock that provably forms, and a proved collision."""

from collections.abc import Callable
from typing import Any

import numpy as np

from flockana.environment import StaticTarget
from flockana.laws import Algorithm1, Algorithm2
from flockana.scenarios.rigorous_verdicts import Enclosure
from flockana.scenarios.scenario_builders import OURS, Scenario, refuted, vacuous, verified

_ALL_OF_OS_3 = verified(*(f"os-3:{name}" for name in ("i", "ii", "iii", "iv-instant", "iv-none", "iv-barrier")))


def _flock_of_three(seed: int = 0) -> Scenario:
    q = np.array([[-4.625, -2.5], [4.5, -2.75], [0.25, 5.5]])
    title = "Three agents: their flock and its limit are proved"
    source_text = (
        "Ours: three agents at rest, out of each other's range, with the γ-agent between them, Algorithm 2 with the "
        "default gains. A tube encloses the run while the links form, until it is in a certified basin: all of Theorem "
        "3 holds, its limit included. The start is fixed."
    )
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    p = np.zeros((3, 2))
    expected = verified("energy", "os-3") | _ALL_OF_OS_3
    enclosure = Enclosure(("os-3",), limit=True)
    return Scenario(
        "proved-flock", title, source_text, law, q, p, (0.0, 1.25), seed, expected, references=OURS, enclosed=enclosure
    )


def _collision(seed: int = 0) -> Scenario:
    title = "Two agents head on: that they collide is proved"
    source_text = (
        "Ours: two agents on a line, 1 apart, at 32 towards each other, Algorithm 1 with the default gains, H(0) = "
        "1.6 c*. A tube shows them in the other order, so they met: no bound above c* excludes a collision. The start "
        "is fixed."
    )
    q, p = np.array([[0.0], [1.0]]), np.array([[32.0], [-32.0]])
    expected = verified("energy") | vacuous("collision-energy:below") | refuted("collision-energy:twice")
    more: dict[str, Any] = {"references": OURS, "enclosed": Enclosure(("collision-energy",))}
    return Scenario("proved-collision", title, source_text, Algorithm1(), q, p, (0.0, 0.0625), seed, expected, **more)


SCENARIOS: dict[str, Callable[..., Scenario]] = {"proved-flock": _flock_of_three, "proved-collision": _collision}
