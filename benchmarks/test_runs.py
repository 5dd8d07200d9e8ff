"""Whole runs: the paper's Fig. 10, fixed steps at large n, and what a bound between samples costs."""

from __future__ import annotations

import numpy as np

from flockana.dynamics.simulate import simulate
from flockana.laws.olfati_saber import Algorithm1
from flockana.measures.path_bounds import closest_approach
from flockana.scenarios import scenario

from .conftest import best
from .test_kernels import flock


def test_figure_10(benchmark, ratio):
    """n = 150, 60 time units, rtol 1e-8: asked are single seconds."""
    case = scenario("paper-flocking")
    assert case.t_span[1] - case.t_span[0] >= 60.0
    run = benchmark.pedantic(case.run, rounds=3, warmup_rounds=1)
    residual = float(np.abs(run.energy_residual).max() / np.abs(run.energy()).max())
    ratio("Fig. 10: energy-balance residual", residual, "of the largest |H|, at rtol 1e-8")


def test_rk4_spends_its_time_in_the_law(benchmark, ratio):
    law, (q, p) = Algorithm1(), flock(10_000)

    def steps():
        return simulate(law, q, p, (0.0, 0.05), method="RK4", dt=0.005, t_eval=[0.05])

    evaluations = steps().stats["evaluations"]
    value = best(steps, repeat=3) / (evaluations * best(lambda: law.flow(0.0, q, p)))
    ratio("RK4, n = 1e4", value, "time over that of its evaluations of the law alone")
    benchmark.pedantic(steps, rounds=3)


def test_closest_approach_against_the_run(benchmark, ratio):
    case = scenario("paper-flocking")
    run = case.run()

    def bound():
        return closest_approach(run.t, run.q, run.p, run.u)

    ratio(
        "bounding all distances between samples",
        best(bound, repeat=3) / best(case.run, repeat=2),
        "time over the run's",
    )
    benchmark.pedantic(bound, rounds=3)
