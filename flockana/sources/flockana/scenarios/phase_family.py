"""Scenario family over two parameters: flocking, fragmentation and collapse."""

from math import sqrt

import numpy as np

from flockana.base.value_checks import ensure_count, ensure_nonnegative, ensure_positive
from flockana.environment import StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws import Algorithm2
from flockana.scenarios.scenario_builders import OURS, Scenario, verified

_C1_ALPHA = 5.0
_END = 60.0


def _phase(seed: int = 0, ratio: float = 0.01, density: float = 0.3, n: int = 40) -> Scenario:
    """Return a scenario of Algorithm 2 from a random start, by ratio c1γ/c1α, density and number of agents."""
    ratio, density = ensure_nonnegative("ratio", ratio), ensure_positive("density", density)
    alpha, c1_gamma = AlphaInteraction(), ratio * _C1_ALPHA
    gains = Gains(c1_alpha=_C1_ALPHA, c2_alpha=2.0 * sqrt(_C1_ALPHA), c1_gamma=c1_gamma, c2_gamma=2.0 * sqrt(c1_gamma))
    side = alpha.d * sqrt(ensure_count("n", n) / density)
    generator = np.random.default_rng(seed)
    title = f"{n} agents, c1γ/c1α = {ratio:g}, {density:g} agents per d² at the start"
    source_text = (
        "Ours: Algorithm 2 with d, r, ε, a, b, h of Fig. 10, c1α = 5, c2 = 2√c1 for both gains, a γ-agent at rest at "
        "the origin, q uniform in a square about it that holds the given number of agents per d² (a lattice has "
        "2/√3), p uniform in [-1, 1]², 60 time units."
    )
    law = Algorithm2(alpha, gains, StaticTarget((0.0, 0.0)))
    q, p = generator.uniform(-0.5 * side, 0.5 * side, (n, 2)), generator.uniform(-1.0, 1.0, (n, 2))
    expected = verified("energy", "os-3:i")
    return Scenario("phase", title, source_text, law, q, p, (0.0, _END), seed, expected, references=OURS)


SCENARIOS = {"phase": _phase}
