"""Ensembles: what a second core gains, and what executor and store cost per run."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

from flockana.ensemble import ensemble
from flockana.ensemble.one_run import Job, Request, run_one
from flockana.ensemble.worker_processes import ProcessPool, cores
from flockana.scenarios import scenario

RUNS = 64
ROUNDS = 1  # the serial and the parallel call take turns, if more


def short(seed):
    """Fig. 10 up to t = 2."""
    return replace(scenario("paper-flocking", seed), t_span=(0.0, 2.0))


def timed(work):
    started = time.perf_counter()
    result = work()
    return result, time.perf_counter() - started


@pytest.mark.skipif(cores() < 2, reason="one core")
def test_two_cores_for_64_runs_of_150_agents(benchmark, ratio):
    """Whole calls: starting the processes, loading the kernels and gathering the results included. Asked: 0.85."""
    alone, both = [], []
    for _ in range(ROUNDS):
        serial, seconds = timed(lambda: ensemble("paper-flocking", range(RUNS), theorems=[], jobs=1))
        alone.append(seconds)
        parallel, seconds = timed(lambda: ensemble("paper-flocking", range(RUNS), theorems=[], jobs=2))
        both.append(seconds)
        assert serial.drop_vars("seconds").identical(parallel.drop_vars("seconds"))
    value = min(alone) / (2.0 * min(both))
    ratio("ensemble, 64 runs of n = 150", value, "parallel efficiency on 2 cores (asked >= 0.85)")
    benchmark.pedantic(lambda: ensemble("hexagon", range(8), theorems=[], jobs=2), rounds=1)


def test_overhead_of_store_and_executor(benchmark, ratio, tmp_path):
    """With one worker, all that a call takes beyond its runs, which time themselves; short runs of n = 150."""
    found = []
    with ProcessPool(1) as pool:
        for k in range(6):
            seeds, file = range(16 * k, 16 * k + 16), tmp_path / f"{k}.sqlite"
            dataset, whole = timed(lambda s=seeds, f=file: ensemble(short, s, theorems=[], executor=pool, store=f))
            found.append(whole / float(dataset.seconds.sum()) - 1.0)
    value = float(np.median(found[1:]))  # the first starts the worker
    ratio("ensemble, overhead of store and executor", value, "of a run of n = 150 and 2 time units (asked < 0.05)")
    request = Request(f"{__name__}:short", ())
    benchmark.pedantic(lambda: run_one(request, Job(0)), rounds=3)
