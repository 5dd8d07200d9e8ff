"""What it costs to leap over no encounter and to keep the energy's balance: runs with and without the checks."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.dynamics.encounters import Encounters
from flockana.dynamics.simulate import simulate
from flockana.kernels.step_checks import Rules
from flockana.laws.olfati_saber import Algorithm1
from flockana.scenarios import scenario

from .conftest import best
from .flocks import gas as flock

CASES = ("phase", "paper-flocking", "spheres-3d")  # 40 agents, 150, 40 among obstacles


def blind(law, n):
    """No encounters, of whatever law; every integrator asks for those of its law once."""
    return Encounters(np.empty((n, 0)), np.inf)


@pytest.mark.parametrize("name", CASES)
def test_checks_of_every_step(benchmark, ratio, monkeypatch, name):
    case = scenario(name)
    with_both = best(case.run, repeat=3)
    with monkeypatch.context() as patch:
        patch.setattr(Encounters, "of", blind)
        without_meetings = best(case.run, repeat=3)
        patch.setattr(Encounters, "rules", lambda *_, fixed: Rules(False, False, False, (0.0, 0.0), fixed))
        without_both = best(case.run, repeat=3)
    ratio(f"{name}: encounters", with_both / without_meetings, "time over that without the check of encounters")
    ratio(f"{name}: encounters and balance", with_both / without_both, "time over that without any check")
    benchmark.pedantic(case.run, rounds=1)


@pytest.mark.parametrize("n", [1000, 4000])
def test_rk4_of_a_large_flock(benchmark, ratio, monkeypatch, n):
    """One search for pairs beside four."""
    q0, p0 = flock(n)

    def run():
        return simulate(Algorithm1(), q0, p0, (0.0, 0.1), method="RK4", dt=0.005, t_eval=[0.1])

    checked = best(run, repeat=3)
    with monkeypatch.context() as patch:
        patch.setattr(Encounters, "of", blind)
        plain = best(run, repeat=3)
    ratio(f"RK4, n = {n}: encounters", checked / plain, "time over that without the check")
    benchmark.pedantic(run, rounds=1)
