"""The sum over a list's pairs by two threads against one, wall time, and a whole run by both."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.flocks import FLOCKS, R
from benchmarks.machine import all_cores, cores
from benchmarks.rows import Asked, Found, Row
from flockana.dynamics.simulate import simulate
from flockana.dynamics.threads import threads_of_numba
from flockana.kernels.slabs import sum_of_slabs
from flockana.kernels.verlet import SKIN, list_pairs, spatial_order
from flockana.laws.olfati_saber import Algorithm1

STUDY = "Threads"
_SIZES = (10_000, 100_000)
_FASTER = Asked(
    ">=", 1.5, why="Two processors of a rented machine may be threads of one core, and share its units of arithmetic."
)
_NOTE = "wall time: the fastest of the rounds, as other programs take cores away"


def study(*, quick: bool) -> Found:
    """Nothing is measured on one core; the threads agree to the bit, or nothing is."""
    with all_cores():
        if cores() < 2:
            return Found([], ("threads: there is one core",))
        return Found([row for n in _SIZES for row in _rows(n, rounds=30 if quick else 100)], (_NOTE,))


def _rows(n: int, rounds: int) -> list[Row]:
    law, (q, p) = Algorithm1(), FLOCKS["gas"](n)
    sums = {threads: _sum(law, q, p, threads) for threads in (1, 2)}
    runs = {threads: _run(law, q, p, threads) for threads in (1, 2)}
    rows = []
    for what, calls, times, unit in (
        ("the sum over all pairs, listed", sums, rounds, "ms"),
        ("a run of 10 steps of RK4, lists and all else by one", runs, max(3, rounds // 10), "ms"),
    ):
        for mine, other in zip(calls[1](), calls[2](), strict=True):
            np.testing.assert_array_equal(mine, other)
        one, two = _fastest(calls, times)
        asked = _FASTER if calls is sums else None
        against = f"one thread: {1e3 * one:.4g} ms"
        rows.append(Row(STUDY, f"times faster with two threads: {what}", n, 1e3 * two, unit, against, one / two, asked))
    return rows


def _sum(law: Algorithm1, q: Any, p: Any, threads: int) -> Callable[[], tuple[Any, ...]]:
    """The term of the pairs over a list with the skin of a run."""
    term, few = law.compiled(2).terms[0], np.empty(1, np.uint32)  # type: ignore[union-attr]
    order = spatial_order(q, (1.0 + SKIN) * R)
    q, p, own = q[order].copy(), p[order].copy(), np.arange(len(q), dtype=np.uint64)
    first, second, _, slabs = list_pairs(q, (1.0 + SKIN) * R, few, few)
    summed, still, given = sum_of_slabs(threads > 1), np.zeros((2, 2)), (np.array(term.numbers), np.array(term.panels))

    def call() -> tuple[Any, ...]:
        u = np.zeros_like(q)
        with threads_of_numba(threads):
            power = summed(term.act, 0.0, q, p, u, still, *given, first, second, slabs, own)
        return u, power

    return call


def _run(law: Algorithm1, q: Any, p: Any, threads: int) -> Callable[[], tuple[Any, ...]]:
    def call() -> tuple[Any, ...]:
        run = simulate(law, q, p, (0.0, 0.05), method="RK4", dt=0.005, t_eval=[0.05], threads=threads)
        return run.q, run.p

    return call


def _fastest(calls: dict[int, Callable[[], tuple[Any, ...]]], rounds: int) -> tuple[float, float]:
    """Wall seconds of both, taking turns."""
    least = {1: np.inf, 2: np.inf}
    for _ in range(rounds):
        for threads, call in calls.items():
            started = time.perf_counter()
            call()
            least[threads] = min(least[threads], time.perf_counter() - started)
    return least[1], least[2]
