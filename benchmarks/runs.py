"""Whole runs: the paper's Fig. 10 by every method, and what fixed steps and bounds cost beside the law alone."""

from __future__ import annotations

from functools import partial

import numpy as np

from benchmarks.flocks import gas
from benchmarks.rows import Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.dynamics.simulate import simulate
from flockana.laws.olfati_saber import Algorithm1
from flockana.measures.path_bounds import closest_approach
from flockana.scenarios import scenario
from flockana.solvers.solver_names import METHODS

STUDY = "Whole runs"
STIFF = ("Radau", "BDF")  # dense Jacobians of 600 states by differences: minutes a run
TOLERANCE = 1e-8


def study(*, quick: bool) -> Found:
    """Fig. 10 (150 agents, 60 time units) by all methods but the stiff ones, then RK4 and the bounds."""
    rounds = 2 if quick else 5
    return Found([*_figure_10(rounds), *_fixed_steps(rounds), *_bounds(rounds)], [_left_out()])


def methods() -> tuple[str, ...]:
    """The adaptive methods that are worth a run of 150 agents."""
    return tuple(
        method for method in METHODS if not method.endswith((*STIFF, "RK4", "scipy-LSODA"))
    )  # LSODA is scipy's


def peer(method: str) -> str | None:
    """The same method of solve_ivp, if there are both."""
    name = f"scipy-{method}"
    return name if name in METHODS else None


def _left_out() -> str:
    return f"{' and '.join(STIFF)} are left out of the runs: they form dense Jacobians of 600 states by differences"


def _figure_10(rounds: int) -> list[Row]:
    case = scenario("paper-flocking")

    def run(method: str) -> object:
        return simulate(case.law, case.q0, case.p0, case.t_span, method=method, rtol=TOLERANCE)

    found = interleaved({name: partial(run, name) for name in methods()}, rounds=rounds)
    rows = []
    for name, seconds in found.items():
        other = peer(name)
        compared: tuple[str, float | None] = ("", None)
        if other is not None and other in found:
            compared = f"{other}: {1e3 * float(np.median(found[other])):.4g} ms", ratio(found[other], seconds)
        what = f"Fig. 10, {name}, rtol {TOLERANCE:g}" + (": times faster" if other in found else "")
        rows.append(Row(STUDY, what, 150, 1e3 * float(np.median(seconds)), "ms", *compared))
    return rows


def _fixed_steps(rounds: int) -> list[Row]:
    law, (q, p) = Algorithm1(), gas(10_000)

    def steps() -> object:
        return simulate(law, q, p, (0.0, 0.05), method="RK4", dt=0.005, t_eval=[0.05])

    evaluations = simulate(law, q, p, (0.0, 0.05), method="RK4", dt=0.005, t_eval=[0.05]).stats["evaluations"]
    found = interleaved({"steps": steps, "law": lambda: law.flow(0.0, q, p)}, rounds=rounds)
    value = 1e3 * float(np.median(found["steps"]))
    against = "its evaluations of the law alone"
    return [
        Row(STUDY, "10 steps of RK4", 10_000, value, "ms", against, ratio(found["steps"], evaluations * found["law"]))
    ]


def _bounds(rounds: int) -> list[Row]:
    case = scenario("paper-flocking")
    run = case.run()
    calls = {"bound": lambda: closest_approach(run.t, run.q, run.p, run.u), "run": case.run}
    found = interleaved(calls, rounds=rounds)
    value, against = 1e3 * float(np.median(found["bound"])), "Fig. 10's run"
    return [
        Row(
            STUDY,
            "all distances between samples, bounded",
            150,
            value,
            "ms",
            against,
            ratio(found["bound"], found["run"]),
        )
    ]
