"""Algorithm 2's right-hand side, as Python sees it, against plain numpy."""

from __future__ import annotations

import numpy as np

from benchmarks.flocks import gas
from benchmarks.numpy_laws import by_agents, by_all_pairs
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm2

STUDY = "Right-hand side against numpy"
_DENSE = {150: 200.0, 1000: 1000.0}
_LOOP = {150: 100.0, 1000: None}


def study(*, quick: bool) -> Found:
    """n = 150 and 1000, of the gas; the three agree to rounding, or nothing is timed."""
    law, rows = Algorithm2(target=StaticTarget((0.0, 0.0))), []
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
        absolute = Asked("<=", 8.0, "value") if n == 150 else None
        rows.append(Row(STUDY, "one evaluation, seen from Python", n, value, "µs", asked=absolute))
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
