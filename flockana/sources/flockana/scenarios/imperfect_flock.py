"""Algorithm 2 with realistic imperfections: sensors, messages, clocks, actuators and wind."""

from collections.abc import Callable
from typing import Any

import numpy as np

from flockana.environment import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.laws import Algorithm2, Delayed, Disturbed, Lossy, Measured, Sampled, Saturated
from flockana.scenarios.scenario_builders import Scenario, vacuous, verified
from flockana.solvers.wrapped_steps import Stepped

DT, LAG, PERIOD, LOSS, LIMIT, NOISE, WIND = 0.01, 0.01, 0.02, 0.05, 20.0, 0.002, 0.5


def _as_built(seed: int = 0) -> Scenario:
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    sensed_law = Measured(Lossy(law, LOSS, seed=seed), NOISE, NOISE, "neighbours", seed=seed)
    applied_law = Saturated(Sampled(Delayed(sensed_law, LAG, "neighbours"), PERIOD), LIMIT)
    q = hexagonal_patch(2, 7.0) + np.random.default_rng(seed).uniform(-0.5, 0.5, (19, 2))
    title = "Algorithm 2 as it is built: late and lost messages, noise, sampling, limits, wind"
    source = (
        f"Ours: a hexagon of 19 under the paper's law, its places off by up to 0.5. Agents hear each other {LAG:g} "
        f"late, with noise, lose one message in {1.0 / LOSS:g}, compute every {PERIOD:g} and accelerate by at most "
        f"{LIMIT:g}; white noise of intensity {WIND:g} pushes them. Steps of {DT:g}."
    )
    stepped_law: Any = Stepped(Disturbed(applied_law, intensity=WIND, seed=seed), DT, 2)
    return Scenario("as-built", title, source, stepped_law, q, np.zeros_like(q), (0.0, 20.0), seed, vacuous("os-3"))


def _swinging_push(seed: int = 0) -> Scenario:
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    rng = np.random.default_rng(seed)
    q = find_equilibrium(law, hexagonal_spiral(3, 7.0)).q
    swing = 0.05 * rng.uniform(-1.0, 1.0, q.shape)
    title = "Three agents in a gusty wind: the bound that a certified basin gives"
    source = (
        "Ours: a triangle under the paper's Algorithm 2, off its equilibrium by 0.02, pushed by a sinusoidal force of "
        "its own for each agent, up to 0.05 in each coordinate."
    )
    windy = Disturbed(law, swing=swing, frequency=0.2)
    q = q + 0.02 * rng.uniform(-1.0, 1.0, q.shape)
    return Scenario("wind", title, source, windy, q, np.zeros_like(q), (0.0, 30.0), seed, verified("disturbed-basin"))


SCENARIOS: dict[str, Callable[[int], Scenario]] = {"as-built": _as_built, "wind": _swinging_push}
