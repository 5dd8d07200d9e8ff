"""Time per pair in range against a C loop, for three flocks from 10⁴ to 10⁶ agents."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.c_loop import MISSING, Loop, compiled
from benchmarks.flocks import FLOCKS, Flock, R
from benchmarks.listed import listed_evaluation
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.base.value_checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.targets import StaticTarget
from flockana.kernels.neighbours import pair_blocks
from flockana.laws.olfati_saber import Algorithm2

STUDY = "Time per pair"
SKIN = 1.0  # of the list that the C loop keeps
STEPS, DT = 10, 0.005  # of the run whose evaluations are counted
_SIZES = (10_000, 100_000, 1_000_000)
_WITHIN = Asked(
    "<=",
    1.5,
    why="The C loop fuses products with sums and reorders them for the widest vectors there are; ours gives the same "
    "bits on every processor.",
)
_GROWS = Asked(
    "<=",
    1.5,
    why="At 10⁴ the flock is in the caches; at 10⁶ each agent is fetched from memory to be sorted, out of order if the "
    "flock is.",
)


def study(*, quick: bool) -> Found:
    """Every flock at every size; the largest is left out where a few minutes must do."""
    law, library = Algorithm2(target=StaticTarget((0.0, 0.0))), compiled()
    rows: list[Row] = []
    for name, build in FLOCKS.items():
        per_agent: dict[int, float] = {}
        for n in _SIZES[: 2 if quick else 3]:
            found, pairs = _timed(law, library, build(n), rounds=3 if quick or n > 100_000 else 7)
            rows += _rows(name, n, pairs, found)
            per_agent[n] = float(np.median(found["ours"])) / n
        largest = max(per_agent)
        growth = per_agent[largest] / per_agent[10_000]
        asked = _GROWS if largest == 1_000_000 else None
        value = 1e9 * per_agent[largest]
        rows.append(Row(STUDY, f"{name}: time per agent", largest, value, "ns", "that at n = 10 000", growth, asked))
    return Found(rows, () if library else (MISSING,))


def _timed(law: Algorithm2, library: Any, flock: Flock, rounds: int) -> tuple[dict[str, FloatArray], int]:
    """CPU seconds of an evaluation, of one in a run, and of the C loop; and how many pairs are in range."""
    q, p = flock
    pairs = sum(i.size for i, _ in pair_blocks(q, R))
    listed, order = listed_evaluation(law, q, p)
    calls: dict[str, Any] = {"ours": lambda: law.flow(0.0, q, p), "listed": listed, "run": lambda: _steps(law, q, p)}
    u, rate = law.flow(0.0, q, p)
    np.testing.assert_allclose(listed()[0], u[order], rtol=0.0, atol=1e-11 * np.abs(u).max())
    np.testing.assert_allclose(listed()[1], rate, rtol=1e-9)
    if library is not None:
        kept, fresh = Loop(library, law, len(q)), Loop(library, law, len(q))
        kept.build(q, p, SKIN)
        in_c = kept.flow(q, p)
        np.testing.assert_allclose(in_c[0], u, rtol=0.0, atol=1e-11 * np.abs(u).max())
        np.testing.assert_allclose(in_c[1], rate, rtol=1e-9)
        calls |= {"kept": lambda: kept.flow(q, p), "rebuilt": lambda: fresh.rebuilt_flow(q, p)}
    found = interleaved(calls, rounds=rounds)
    found["run"] = found["run"] / _steps(law, q, p).stats["evaluations"]
    if library is not None:
        kept.close()
        fresh.close()
    return found, pairs


def _steps(law: Algorithm2, q: FloatArray, p: FloatArray) -> Trajectory:
    return simulate(law, q, p, (0.0, STEPS * DT), method="RK4", dt=DT, t_eval=[STEPS * DT])


_COMPARED = (
    ("ours", "one evaluation", "rebuilt", "C, list rebuilt", _WITHIN),
    ("ours", "one evaluation", "kept", "C, list kept", None),
    ("listed", "an evaluation over a kept list", "kept", "C, list kept", _WITHIN),
    ("run", "an evaluation in a run of RK4, with its share of lists, energies and steps", "kept", "C, list kept", None),
)


def _rows(name: str, n: int, pairs: int, found: dict[str, FloatArray]) -> list[Row]:
    rows = []
    for ours, what, theirs, text, asked in _COMPARED:
        if (name, n, ours, theirs) == ("gas", 1_000_000, "ours", "kept"):  # pairs few and far between
            asked = Asked("<=", 2.5)
        value, unit = 1e9 * float(np.median(found[ours])) / pairs, "ns per pair"
        if theirs in found:
            against = f"{text}: {1e9 * float(np.median(found[theirs])) / pairs:.3g} ns"
            rows.append(
                Row(STUDY, f"{name}: {what}", n, value, unit, against, ratio(found[ours], found[theirs]), asked)
            )
        else:
            rows.append(Row(STUDY, f"{name}: {what}", n, value, unit))
    return list(dict.fromkeys(rows))  # without a baseline two of them are one
