"""Small scenarios at the limits of a claim, as starts for counterexample searches."""

from math import sqrt

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.environment import Sphere, StaticTarget
from flockana.interactions import Gains
from flockana.laws import Algorithm1, Algorithm3, paper_pair
from flockana.scenarios.lazy_start import lazy_array
from flockana.scenarios.scenario_builders import (
    OURS,
    Builder,
    Scenario,
    Status,
    entry,
    inconclusive,
    refuted,
    vacuous,
    verified,
)
from flockana.sources.geschwender_2016 import rhombus_with_double_agent


def _head_on(name: str, apart: float, share: float, expected: dict[str, Status]) -> Builder:
    """Return the scenario builder of two approaching agents on a line, with a given share of c* as energy."""
    law, q = Algorithm1(), np.array([[0.0], [apart]])

    def velocities() -> FloatArray:
        kinetic = share * law.gains.c1_alpha * paper_pair(law).c_star - law.energy(0.0, q, 0.0 * q)
        speed = sqrt(kinetic)  # K = speed²
        return np.array([[speed], [-speed]])

    title = f"Two agents head on, with {share:g} c* of energy"
    source_text = (
        f"Ours: two agents on a line, {apart:g} apart, with equal and opposite velocities, H(0) = {share:g} c*, "
        "Algorithm 1 with the default gains. The start is fixed."
    )
    start, statuses = (q, lazy_array((2, 1), velocities)), verified("energy") | expected
    return entry(name, title, source_text, law, lambda seed: start, 3.0, statuses, references=OURS)


def _five_agents(seed: int = 0) -> Scenario:
    """Return the scenario on erratum E3 that starts next to the basin of the smallest known strained minimum."""
    law = Algorithm1(gains=Gains(c2_alpha=20.0))
    q = rhombus_with_double_agent(law.alpha.length)
    q[4] += (0.0, 0.5)
    title = "Five agents: two of them next to one corner of a rhombus"
    source_text = (
        "Ours, on erratum E3: a rhombus of side d = 7 with two agents at one corner, 0.5 apart, at rest, Algorithm 1 "
        "with c1α = 30, c2α = 20. The two part and all five come near a lattice, which can flex. The start is fixed."
    )
    p = np.zeros((5, 2))
    expected = verified("energy") | inconclusive("lattice-limit-printed")
    return Scenario("five-agents", title, source_text, law, q, p, (0.0, 40.0), seed, expected, references=OURS)


def _beside_a_sphere(seed: int = 0) -> Scenario:
    title = "Two agents pulled together beside a sphere"
    source_text = (
        "Ours, on erratum E2: two agents at rest 16 apart, out of each other's range, the γ-agent between them and a "
        "sphere of radius 2 beside it, Algorithm 3 with the default gains. The start is fixed."
    )
    law = Algorithm3(target=StaticTarget((2.0, 0.0)), obstacles=(Sphere((2.0, 5.8), 2.0),))
    q, p = np.array([[-6.0, 0.0], [10.0, 0.0]]), np.zeros((2, 2))
    expected = verified("energy") | inconclusive("energy-printed")
    return Scenario("beside-a-sphere", title, source_text, law, q, p, (0.0, 1.0), seed, expected, references=OURS)


SCENARIOS: dict[str, Builder] = {
    "head-on": _head_on("head-on", 7.0, 0.5, verified("collision-energy", "collision-energy:below")),
    "head-on-collision": _head_on(
        "head-on-collision", 1.0, 1.2, vacuous("collision-energy:below") | refuted("collision-energy:twice")
    ),
    "five-agents": _five_agents,
    "beside-a-sphere": _beside_a_sphere,
}
