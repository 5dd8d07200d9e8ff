"""The search for pairs: directly or by cells, and with one agent far away."""

from __future__ import annotations

import numpy as np

from benchmarks.flocks import R, gas
from benchmarks.rows import Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.kernels.neighbours import pair_blocks
from flockana.laws.olfati_saber import Algorithm1

STUDY = "Search for pairs"


def study(*, quick: bool) -> Found:
    """Cells are used where the direct search over them exceeds 1."""
    rounds, rows = 3 if quick else 9, []
    for n in (64, 128, 256, 1024):
        q, _ = gas(n)
        calls = {way: lambda q=q, way=way: _count(q, dense=way == "direct") for way in ("direct", "cells")}
        found = interleaved(calls, rounds=rounds)
        value = 1e6 * float(np.median(found["direct"]))
        rows.append(Row(STUDY, "direct", n, value, "µs", "by cells", ratio(found["direct"], found["cells"])))
    law, (q, p) = Algorithm1(), gas(10_000)
    far = q.copy()
    far[0] = 1e12
    found = interleaved({"far": lambda: law.flow(0.0, far, p), "near": lambda: law.flow(0.0, q, p)}, rounds=rounds)
    value, against = 1e3 * float(np.median(found["far"])), "the compact flock"
    rows.append(Row(STUDY, "one agent at 1e12", 10_000, value, "ms", against, ratio(found["far"], found["near"])))
    return Found(rows)


def _count(q: np.ndarray, *, dense: bool) -> int:
    return sum(i.size for i, _ in pair_blocks(q, R, dense=dense))
