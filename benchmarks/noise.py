"""Runs with noise and disturbances: against the same scheme without, and many seeds on two cores."""

from __future__ import annotations

import time

import numpy as np

from benchmarks.flocks import Flock
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.dynamics.simulate import simulate
from flockana.ensemble import ensemble
from flockana.environment.targets import StaticTarget
from flockana.lattice import hexagonal_spiral
from flockana.laws.disturbed_law import Disturbed
from flockana.laws.olfati_saber import Algorithm2
from flockana.scenarios.scenario import Scenario
from flockana.solvers.taylor_step import TaylorStep

STUDY = "Noise and disturbances"
DT, SPAN, SEEDS, AGENTS, ASKED = 0.01, 60.0, 200, 50, 10.0


def study(*, quick: bool) -> Found:
    """A run of 50 agents with noise and with a force against one without; 200 seeds of 60 time units on two cores."""
    law, (q, p) = Algorithm2(target=StaticTarget((0.0, 0.0))), _start()
    span, rounds = (0.0, 5.0), 3 if quick else 9
    noisy, windy, steps = Disturbed(law, intensity=0.1), Disturbed(law, force=(0.1, 0.2)), TaylorStep(law, DT)
    pairs = {
        "Euler-Maruyama, white noise": (
            lambda: simulate(noisy, q, p, span, dt=DT, method="Euler-Maruyama"),
            lambda: simulate(steps, q, p, span),
        ),
        "RK4, a constant force": (
            lambda: simulate(windy, q, p, span, dt=DT, method="RK4"),
            lambda: simulate(law, q, p, span, dt=DT, method="RK4"),
        ),
    }
    rows = []
    for name, (with_it, without) in pairs.items():
        found = interleaved({"with": with_it, "without": without}, rounds=rounds)
        value, against = 1e6 * float(np.median(found["with"])) * DT / span[1], "the same steps without it"
        share = ratio(found["with"], found["without"])
        rows.append(Row(STUDY, f"{name}: a step", AGENTS, value, "µs", against, share, Asked("<=", 1.5)))
    seconds, asked = _seeds(20 if quick else SEEDS), None if quick else Asked("<=", 1.0)
    name = f"{20 if quick else SEEDS} seeds of Euler-Maruyama for {SPAN:g}, two workers: wall time"
    rows.append(Row(STUDY, name, AGENTS, seconds, "s", "10 s, as asked", seconds / ASKED, asked))
    return Found(rows)


def _start() -> Flock:
    q = hexagonal_spiral(AGENTS, 7.0)
    return q, np.zeros_like(q)


def noisy_flock(seed: int) -> Scenario:
    """A hexagonal spiral under Algorithm 2 in white noise."""
    from flockana.solvers.wrapped_steps import Stepped

    law = Stepped(Disturbed(Algorithm2(target=StaticTarget((0.0, 0.0))), intensity=0.1, seed=seed), DT, 1)
    return Scenario("noisy", "white noise", "a benchmark", law, *_start(), (0.0, SPAN), seed, {})


def _seeds(count: int) -> float:
    """Wall seconds of an ensemble on two workers, their start included; compiled before."""
    ensemble(noisy_flock, range(2), theorems=[], jobs=1)
    started = time.perf_counter()
    ensemble(noisy_flock, range(count), theorems=[], jobs=2)
    return time.perf_counter() - started
