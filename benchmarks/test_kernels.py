"""Right-hand sides and neighbour search, against a numpy loop over agents and against themselves at other sizes."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.environment.targets import StaticTarget
from flockana.kernels.neighbours import pair_blocks
from flockana.laws.olfati_saber import Algorithm1, Algorithm2

from .conftest import best


def flock(n: int, seed: int = 0):
    """A square of agents at about the lattice's density."""
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, 7.0 * np.sqrt(n), (n, 2)), rng.uniform(-1.0, 1.0, (n, 2))


def per_agent_loop(law: Algorithm1, q, p):
    """One agent after the other in vectorised numpy: how the sources' notebooks compute u."""
    a = law.alpha
    u = np.zeros_like(q)
    for i in range(len(q)):
        delta, relative = np.delete(q - q[i], i, axis=0), np.delete(p - p[i], i, axis=0)
        z = (np.sqrt(1.0 + a.eps * np.sum(delta**2, axis=1)) - 1.0) / a.eps
        x = z / a.r_alpha
        rho = np.where(x < a.h, 1.0, np.where(x < 1.0, 0.5 * (1.0 + np.cos(np.pi * (x - a.h) / (1.0 - a.h))), 0.0))
        near = rho > 0.0
        delta, relative, z, rho = delta[near], relative[near], z[near], rho[near]
        s = z - a.d_alpha + a.c
        phi = 0.5 * ((a.a + a.b) * s / np.sqrt(1.0 + s**2) + (a.a - a.b))
        n_ij = delta / np.sqrt(1.0 + a.eps * np.sum(delta**2, axis=1, keepdims=True))
        u[i] = law.gains.c1_alpha * (rho * phi) @ n_ij + law.gains.c2_alpha * rho @ relative
    return u


def test_right_hand_side_against_a_loop_over_agents(benchmark, ratio):
    law, (q, p) = Algorithm1(), flock(150)
    np.testing.assert_allclose(law.flow(0.0, q, p)[0], per_agent_loop(law, q, p), rtol=1e-9, atol=1e-9)
    compiled = best(lambda: law.flow(0.0, q, p), number=200)
    loop = best(lambda: per_agent_loop(law, q, p), number=2)
    ratio("right-hand side, n = 150", loop / compiled, "times faster than a numpy loop over agents (asked: 100)")
    benchmark(law.flow, 0.0, q, p)


@pytest.mark.parametrize("n", [10_000, 100_000])
def test_right_hand_side_of_a_large_flock(benchmark, n):
    law, (q, p) = Algorithm2(target=StaticTarget((0.0, 0.0))), flock(n)
    benchmark(law.flow, 0.0, q, p)


def test_time_per_agent_grows_little_from_1e4_to_1e5(benchmark, ratio):
    law = Algorithm1()
    small, large = flock(10_000), flock(100_000)
    per_agent = [best(lambda s=s: law.flow(0.0, *s), repeat=15) / len(s[0]) for s in (small, large)]
    ratio("time per agent, n = 1e5 over 1e4", per_agent[1] / per_agent[0], "asked: at most 2")
    benchmark.pedantic(law.flow, args=(0.0, *large), rounds=3)


@pytest.mark.parametrize("n", [64, 128, 256, 1024])
def test_direct_search_against_cells(benchmark, ratio, n):
    q, _ = flock(n)

    def search(dense: bool) -> int:
        return sum(i.size for i, _ in pair_blocks(q, 8.4, dense=dense))

    assert search(True) == search(False)
    value = best(lambda: search(True), number=200) / best(lambda: search(False), number=200)
    ratio(f"direct search over cells, n = {n}", value, "time; cells are used where it exceeds 1")
    benchmark(search, n > 128)


def test_one_agent_far_away_costs_nothing(benchmark, ratio):
    law, (q, p) = Algorithm1(), flock(10_000)
    far = q.copy()
    far[0] = 1e12
    value = best(lambda: law.flow(0.0, far, p)) / best(lambda: law.flow(0.0, q, p))
    ratio("one agent at 1e12, n = 1e4", value, "time over that of the compact flock")
    benchmark(law.flow, 0.0, far, p)
