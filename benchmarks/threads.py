"""One core against two: evaluations and whole runs of large flocks by the clock, and what more cores would give."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from statistics import median

from benchmarks.flocks import FLOCKS
from benchmarks.machine import all_cores
from benchmarks.rows import Asked, Found, Row

STUDY = "Two cores against one"
_SERIAL = "sorting into cells, the copying of vectors and the calls from Python run on one core"
_MEMORY = "sorting into cells on one core, and new memory that both ask for: rounds differ by half"


def study(*, quick: bool) -> Found:
    """Clock times with two threads over those with one, in turns in a process of its own that may use all cores."""
    rows = []
    for kind in ("lattice", "gas"):
        for n in (100_000,) if quick else (100_000, 1_000_000):
            with all_cores():
                command = [sys.executable, "-m", "benchmarks.threads", kind, str(n), "2" if quick else "15"]
                done = subprocess.run(
                    command, capture_output=True, check=True, env=os.environ | {"NUMBA_NUM_THREADS": "2"}
                )
            evaluation, run = json.loads(done.stdout)
            rows.append(_row(f"{kind}: one evaluation", n, evaluation, Asked("<=", 0.6, why=_MEMORY)))
            if n == 100_000:
                rows.append(_row(f"{kind}: ten steps of RK4", n, run, Asked("<=", 0.65, why=_SERIAL)))
    return Found(rows)


def _row(name: str, n: int, times: list[list[float]], asked: Asked) -> Row:
    share = median(two / one for one, two in times)
    serial = min(1.0, max(0.0, 2.0 * share - 1.0))
    eight, sixteen = (serial + (1.0 - serial) / cores for cores in (8, 16))
    note = (
        f"serial share {serial:.2f}: 8 cores would take {eight:.2f}, 16 {sixteen:.2f}, if nothing else were in the way"
    )
    return Row(STUDY, name, n, 1e3 * median(two for _, two in times), "ms", "one core", share, asked, note)


def _measure(kind: str, n: int, rounds: int) -> list[list[list[float]]]:
    """Return (seconds with one thread, with two) of evaluations and of runs, round by round."""
    from flockana.dynamics.simulate import simulate
    from flockana.kernels.thread_counts import limited_threads
    from flockana.laws.olfati_saber import Algorithm1

    law, (q, p) = Algorithm1(), FLOCKS[kind](n)

    def evaluate(threads: int) -> None:
        with limited_threads(threads):
            law.flow(0.0, q, p)

    def run(threads: int) -> None:
        simulate(law, q, p, (0.0, 0.05), method="RK4", dt=0.005, t_eval=[0.05], threads=threads)

    found = []
    for call in (evaluate, run) if n == 100_000 else (evaluate,):
        for threads in (1, 2):
            call(threads)
        found.append([[_seconds(call, threads) for threads in (1, 2)] for _ in range(rounds)])
    return [*found, []][:2]


def _seconds(call: object, threads: int) -> float:
    started = time.perf_counter()
    call(threads)  # type: ignore[operator]
    return time.perf_counter() - started


if __name__ == "__main__":
    sys.stdout.write(json.dumps(_measure(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))))
