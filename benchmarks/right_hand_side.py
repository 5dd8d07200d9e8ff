"""Algorithm 2's right-hand side, as Python sees it, alone and against plain numpy."""

from __future__ import annotations

import numpy as np

from benchmarks.c_loop import Loop, compiled
from benchmarks.flocks import FLOCKS, gas
from benchmarks.listed import listed_evaluation
from benchmarks.numpy_laws import by_agents, by_all_pairs
from benchmarks.pairs import SKIN
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm2

STUDY = "Right-hand side against numpy"
_SOUGHT = "By itself a law knows no list of pairs, and to seek them takes half of it; in runs it is handed one."
_DENSE = {150: 200.0, 1000: 1000.0}
_TIMES = 100  # that the C loop repeats itself in a call
_LOOP = {150: 100.0, 1000: None}


def study(*, quick: bool) -> Found:
    """n = 150 and 1000, of the gas; the three agree to rounding, or nothing is timed."""
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    rows = _alone(law, rounds=3 if quick else 9)
    for n in (150, 1000):
        q, p = gas(n)
        u = law.flow(0.0, q, p)[0]
        for other in (by_agents, by_all_pairs):
            np.testing.assert_allclose(u, other(law, q, p), rtol=0.0, atol=1e-12 * n * np.abs(u).max())
        calls = {
            "ours": lambda q=q, p=p: law.flow(0.0, q, p),
            "agents": lambda q=q, p=p: by_agents(law, q, p),
            "pairs": lambda q=q, p=p: by_all_pairs(law, q, p),
        }
        found = interleaved(calls, rounds=3 if quick else 9)
        value = 1e6 * float(np.median(found["ours"]))
        rows.append(Row(STUDY, "one evaluation of the gas", n, value, "µs"))
        for name, what, bounds in (
            ("pairs", "all n × n differences in numpy", _DENSE),
            ("agents", "a numpy loop over agents", _LOOP),
        ):
            base, bound = 1e6 * float(np.median(found[name])), bounds[n]
            asked = None if bound is None else Asked(">=", bound)
            against = f"{what}: {base:.4g} µs"
            rows.append(
                Row(STUDY, "times faster than numpy", n, value, "µs", against, ratio(found[name], found["ours"]), asked)
            )
    return Found(rows)


def _alone(law: Algorithm2, rounds: int) -> list[Row]:
    """150 agents on a lattice: pairs, target and the energy's rate, the pairs searched each time or listed before."""
    q, p = FLOCKS["lattice"](150)
    listed, order = listed_evaluation(law, q, p)
    np.testing.assert_allclose(listed()[0], law.flow(0.0, q, p)[0][order], rtol=0.0, atol=1e-10)
    calls, library = {"searched": lambda: law.flow(0.0, q, p), "kept": listed}, compiled()
    if library is not None:
        kept, fresh = Loop(library, law, len(q)), Loop(library, law, len(q))
        kept.build(q, p, SKIN)
        calls |= {
            "C kept": lambda: kept.repeated(q, p, _TIMES, rebuild=False),
            "C searched": lambda: fresh.repeated(q, p, _TIMES, rebuild=True),
        }
    found, rows = interleaved(calls, rounds=rounds), []
    what = "one evaluation of a lattice, seen from Python"
    kinds = (("searched", what, "rebuilt", _SOUGHT), ("kept", f"{what}, over a kept list", "kept", ""))
    for ours, text, theirs, why in kinds:
        value, against = 1e6 * float(np.median(found[ours])), found.get(f"C {ours}")
        rows.append(Row(STUDY, text, 150, value, "µs", asked=Asked("<=", 8.0, "value", why)))
        if against is not None:
            other = f"C, called from C, list {theirs}: {1e6 * np.median(against) / _TIMES:.3g} µs"
            asked = Asked("<=", 1.4, why=why) if why else None
            rows.append(Row(STUDY, text, 150, value, "µs", other, ratio(_TIMES * found[ours], against), asked))
    return rows
