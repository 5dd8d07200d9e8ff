"""Seven agents of the toy law, from a random start."""

import numpy as np
from flockana.interactions.toy_morse import ToyMorse
from flockana.sources.toy_2026.laws import ToySwarm

from flockana.lattice import hexagonal_patch
from flockana.scenarios.scenario import Scenario


def _build(seed: int = 0) -> Scenario:
    rng = np.random.default_rng(seed)
    q = hexagonal_patch(1, 3.0) + 0.1 * rng.standard_normal((7, 2))
    law = ToySwarm(ToyMorse())
    expected = {"toy-rest": "verified"}
    return Scenario("toy-swarm", "A toy", "ours", law, q, rng.standard_normal((7, 2)), (0.0, 20.0), seed, expected)


SCENARIOS = {"toy-swarm": _build}
