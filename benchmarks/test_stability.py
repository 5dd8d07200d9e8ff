"""Linearised stability: sparse Jacobian and slowest modes, against what one would do without them."""

from __future__ import annotations

import numpy as np

from flockana.environment.targets import StaticTarget
from flockana.equilibria import find_equilibrium
from flockana.lattice import hexagonal_spiral
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.stability import linearise, slowest_modes

from .conftest import best


def jacobian_by_differences(law, q, p, step=1e-6):
    """Central differences of the compiled force: 4 n m right-hand sides, and a dense matrix."""
    size = q.size
    state, found = np.concatenate([q.ravel(), p.ravel()]), np.zeros((2 * size, 2 * size))
    found[:size, size:] = np.eye(size)

    def force(z):
        return law.flow(0.0, z[:size].reshape(q.shape), z[size:].reshape(q.shape))[0].ravel()

    for k in range(2 * size):
        shift = np.zeros(2 * size)
        shift[k] = step
        found[size:, k] = (force(state + shift) - force(state - shift)) / (2.0 * step)
    return found


def test_sparse_jacobian_against_differences(benchmark, ratio):
    """Baseline: central differences of the same compiled right-hand side, the least work that knows no formula."""
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    q = hexagonal_spiral(150, 7.0) + 0.1 * np.random.default_rng(0).standard_normal((150, 2))
    p = 0.1 * q
    exact, differences = law.jacobian(0.0, q, p, sparse=True), jacobian_by_differences(law, q, p)
    np.testing.assert_allclose(exact.toarray(), differences, atol=1e-5 * abs(exact).max())
    analytic = best(lambda: law.jacobian(0.0, q, p, sparse=True), number=20)
    dense = best(lambda: jacobian_by_differences(law, q, p), repeat=3)
    ratio("Jacobian, n = 150", dense / analytic, "times faster than central differences of the compiled force")
    benchmark(lambda: law.jacobian(0.0, q, p, sparse=True))


def test_slowest_modes_against_the_whole_spectrum(benchmark, ratio):
    """Baseline: numpy's dense eigenvalues of A at n = 300, scaled by n³ to n = 2000, where A takes 0.5 GB."""
    law = Algorithm1()
    small = linearise(law, find_equilibrium(law, hexagonal_spiral(300, 7.0)))
    dense = best(lambda: np.linalg.eig(small.A), repeat=1)
    assert abs(slowest_modes(small, 6).modes[0].decay_rate - small.decay_rate) < 1e-7 * small.decay_rate
    few = best(lambda: slowest_modes(small, 6), repeat=2)
    ratio("slowest modes, n = 300", dense / few, "times faster than all eigenvalues of the dense matrix")
    large = linearise(law, hexagonal_spiral(2000, 7.0))  # an exact lattice is at equilibrium as it is
    seconds = best(lambda: slowest_modes(large, 6), repeat=1)
    scaled = dense * (2000.0 / 300.0) ** 3
    ratio("slowest modes, n = 2000", scaled / seconds, "times faster than the dense spectrum, n = 300 scaled by n³")
    benchmark.pedantic(lambda: slowest_modes(small, 6), rounds=2)
