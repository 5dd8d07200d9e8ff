"""Many cores against one: evaluations and whole runs of large flocks by the clock, with 2, 4, 8 and 16 threads."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from statistics import median

from benchmarks.flocks import FLOCKS
from benchmarks.machine import all_cores, cores
from benchmarks.rows import Asked, Found, Row

STUDY = "Many cores against one"
COUNTS = (2, 4, 8, 16)
_SERIAL = "sorting into cells, the copying of vectors and the calls from Python run on one core"
_MEMORY = "sorting into cells on one core, and new memory that both ask for: rounds differ by half"


def study(*, quick: bool) -> Found:
    """Clock times with more threads over those with one, in turns in a process of its own that may use all cores."""
    rows = []
    for kind in ("lattice", "gas"):
        for n in (100_000,) if quick else (100_000, 1_000_000):
            with all_cores():
                counts = [count for count in COUNTS if count <= max(cores(), 2)]
                command = [sys.executable, "-m", "benchmarks.threads", kind, str(n), "2" if quick else "15"]
                done = subprocess.run(
                    [*command, *map(str, counts)],
                    capture_output=True,
                    check=True,
                    env=os.environ | {"NUMBA_NUM_THREADS": str(counts[-1])},
                )
            evaluation, run = json.loads(done.stdout)
            rows += _rows(f"{kind}: one evaluation", n, counts, evaluation, Asked("<=", 0.6, why=_MEMORY))
            if n == 100_000:
                rows += _rows(f"{kind}: ten steps of RK4", n, counts, run, Asked("<=", 0.65, why=_SERIAL))
    return Found(rows)


def _rows(name: str, n: int, counts: list[int], rounds: list[list[float]], asked: Asked) -> list[Row]:
    """Return a row for each number of threads; two are asked for something, and say what more of them would give."""
    rows = []
    for k, count in enumerate(counts, 1):
        share, value = median(times[k] / times[0] for times in rounds), 1e3 * median(times[k] for times in rounds)
        serial = min(1.0, max(0.0, (count * share - 1.0) / (count - 1.0)))
        eight, sixteen = (serial + (1.0 - serial) / many for many in (8, 16))
        note = f"serial share {serial:.2f}"
        if count == counts[-1] < 16:
            note += f": 8 cores would take {eight:.2f}, 16 {sixteen:.2f}, if nothing else were in the way"
        bound = asked if count == 2 else None
        rows.append(Row(STUDY, f"{name}, {count} threads", n, value, "ms", "one core", share, bound, note))
    return rows


def _measure(kind: str, n: int, rounds: int, counts: list[int]) -> list[list[list[float]]]:
    """Return the seconds of evaluations and of runs with one thread and with each count, round by round."""
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
        for threads in (1, *counts):
            call(threads)
        found.append([[_seconds(call, threads) for threads in (1, *counts)] for _ in range(rounds)])
    return [*found, []][:2]


def _seconds(call: object, threads: int) -> float:
    started = time.perf_counter()
    call(threads)  # type: ignore[operator]
    return time.perf_counter() - started


if __name__ == "__main__":
    sys.stdout.write(
        json.dumps(_measure(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), [int(x) for x in sys.argv[4:]]))
    )
