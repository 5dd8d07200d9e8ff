"""A million agents for a hundred steps.

Their γ-agent draws them together, the harder the farther they are, in the end the outermost by more than a range a
step: lists of pairs, and who may meet within a step, are judged beside that common motion.
"""

from __future__ import annotations

import numpy as np

from benchmarks.flocks import lattice
from benchmarks.rows import Found, Row
from benchmarks.timing import seconds_of
from flockana.dynamics.simulate import simulate
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm2

STUDY = "A large flock"
DT = 0.005


def study(*, quick: bool) -> Found:
    """RK4, with the energy's balance beside it; a tenth of the agents and a fifth of the steps where that must do."""
    n, steps = (100_000, 20) if quick else (1_000_000, 100)
    law, (q, p) = Algorithm2(target=StaticTarget((0.0, 0.0))), lattice(n)
    runs = []

    def run() -> None:
        end = steps * DT
        runs.append(simulate(law, q, p, (0.0, end), method="RK4", dt=DT, t_eval=[0.0, end]))

    seconds = seconds_of(run)
    off = float(np.abs(runs[0].energy_residual).max() / np.abs(runs[0].energy()).max())
    note = f"{1e9 * seconds / (n * steps):.3g} ns per agent and step; energy balance off by {off:.1g}"
    return Found([Row(STUDY, f"{steps} steps of RK4", n, seconds, "s", note=note)])
