"""Whole runs of RK4 on one core against a C program that neither checks its steps nor sums an energy."""

from __future__ import annotations

from functools import partial

import numpy as np

from benchmarks.c_loop import MISSING, Loop, compiled
from benchmarks.flocks import FLOCKS, Flock
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import interleaved
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm2

STUDY = "Whole runs against C"
DT, SKIN = 0.005, 1.0
FEW, MANY = 10, 40  # steps: their difference is free of the start
_START = (
    "its start takes a fifth to two fifths: the flock is checked, sorted and listed, its energy summed, states kept"
)
_CHECKED = "each step is checked for pairs that meet within it, and the same bits are asked of every processor"


def study(*, quick: bool) -> Found:
    """Ten steps, and a step by itself, of lattices and gases."""
    library = compiled()
    if library is None:
        return Found(notices=(MISSING,))
    law, rows = Algorithm2(target=StaticTarget((0.0, 0.0))), list[Row]()
    for kind in ("lattice", "gas"):
        for n in (10_000,) if quick else (10_000, 100_000):
            loop = Loop(library, law, n)
            rows += _rows(law, loop, kind, FLOCKS[kind](n), rounds=3 if quick else 9)
            loop.close()
    return Found(rows)


def _rows(law: Algorithm2, loop: Loop, kind: str, flock: Flock, rounds: int) -> list[Row]:
    q, p = flock
    run, (end, _, _) = _run(law, q, p, FEW), loop.stepped(q, p, DT, FEW, SKIN)
    np.testing.assert_allclose(run.q[-1], end, rtol=0.0, atol=1e-10)
    calls = {f"ours {k}": partial(_run, law, q, p, k) for k in (FEW, MANY)}
    calls |= {f"C {k}": partial(loop.stepped, q, p, DT, k, SKIN) for k in (FEW, MANY)}  # type: ignore[dict-item]
    found = interleaved(calls, rounds=rounds)
    few = found[f"ours {FEW}"], found[f"C {FEW}"]
    step = [(found[f"{who} {MANY}"] - found[f"{who} {FEW}"]) / (MANY - FEW) for who in ("ours", "C")]
    return [
        _row(f"{kind}: ten steps", len(q), *few, Asked("<=", 2.5, why=_START)),
        _row(f"{kind}: a step, free of the start", len(q), *step, Asked("<=", 2.0, why=_CHECKED)),
    ]


def _row(name: str, n: int, ours: np.ndarray, theirs: np.ndarray, asked: Asked) -> Row:
    against = f"C: {1e3 * float(np.median(theirs)):.3g} ms"
    return Row(STUDY, name, n, 1e3 * float(np.median(ours)), "ms", against, float(np.median(ours / theirs)), asked)


def _run(law: Algorithm2, q: np.ndarray, p: np.ndarray, steps: int) -> Trajectory:
    return simulate(law, q, p, (0.0, steps * DT), method="RK4", dt=DT, t_eval=[steps * DT])
