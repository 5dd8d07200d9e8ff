"""Zone flocking: a step by cells, against one in which all pairs are looked at."""

from __future__ import annotations

import numpy as np

from benchmarks.rows import Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking

STUDY = "Zone flocking"
SPACING = 2.5  # of agents, on average, where they attract each other up to 5


def study(*, quick: bool) -> Found:
    """n = 10³, 10⁴ and 10⁵; an agent at 1e40, where no cells can be made, makes all pairs be looked at."""
    law, rows, rounds = ZoneFlocking(), [], 3 if quick else 7
    for n in (1000, 10_000, 100_000):
        rng = np.random.default_rng(0)
        q, p = rng.uniform(0.0, SPACING * np.sqrt(n), (n, 2)), rng.normal(size=(n, 2))
        calls = {"cells": lambda q=q, p=p: law.iterate(0.0, q, p, law.start(q, p), 1)}
        if n <= 10_000:
            far = np.vstack([q[1:], np.full(2, 1e40)])
            calls["pairs"] = lambda q=far, p=p: law.iterate(0.0, q, p, law.start(q, p), 1)
        found = interleaved(calls, rounds=rounds)
        compared = ("all pairs", ratio(found["cells"], found["pairs"])) if "pairs" in found else ("", None)
        rows.append(Row(STUDY, "one step", n, 1e3 * float(np.median(found["cells"])), "ms", *compared))
    return Found(rows)
