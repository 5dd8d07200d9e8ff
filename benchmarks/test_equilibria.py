"""Equilibria against n: the solve over the whole spectrum of its result, and how the time grows."""

from __future__ import annotations

import numpy as np

from flockana.environment.targets import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.lattice import harborth, hexagonal_spiral
from flockana.laws.olfati_saber import Algorithm1, Algorithm2

from .conftest import best


def disturbed(n):
    return hexagonal_spiral(n, 7.0) + 0.3 * np.random.default_rng(0).standard_normal((n, 2))


def test_equilibria_against_the_spectrum(benchmark, ratio):
    law = Algorithm1()
    seconds = {}
    for n in (37, 150, 400):
        start = disturbed(n)
        found = find_equilibrium(law, start)
        assert len(found.links) == harborth(n)
        seconds[n] = best(lambda start=start: find_equilibrium(law, start), repeat=2)
        dense = law.stiffness(found.q).toarray()
        spectrum = best(lambda dense=dense: np.linalg.eigvalsh(dense), repeat=3)
        ratio(f"equilibrium, n = {n}", seconds[n] / spectrum, "time over that of the spectrum of its Hessian")
    ratio("equilibrium, 400 over 37 agents", seconds[400] / seconds[37], "time, for 10.8 times the agents")
    benchmark.pedantic(lambda: find_equilibrium(law, disturbed(150)), rounds=3)


def test_the_descent_against_ipopt(benchmark, ratio):
    """Under Algorithm 2 the net of 600 gives way: both end in one of many minima, the descent in a lower one."""
    law, start = Algorithm2(target=StaticTarget((0.0, 0.0))), disturbed(600)
    found = {method: find_equilibrium(law, start, method=method) for method in ("descent", "ipopt")}
    assert found["descent"].energy < found["ipopt"].energy
    seconds = {
        method: best(lambda method=method: find_equilibrium(law, start, method=method), repeat=1) for method in found
    }
    ratio("descent, pressed flock, n = 600", seconds["ipopt"] / seconds["descent"], "times faster than IPOPT")
    large = best(lambda: find_equilibrium(law, disturbed(1000)), repeat=1)
    ratio("descent, pressed flock, n = 1000", large, "seconds; asked for: at most 5")
    benchmark.pedantic(lambda: find_equilibrium(law, start), rounds=1)
