"""The minimal model without its edges: what each pair adds, by the perceiving agent's own numbers."""

import numpy as np
import pytest

from flockana.sources.jond_2025.kernels.minimal import edge_forces
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking

RNG = np.random.default_rng(5)
RADII, BETAS, SPACINGS = (tuple(RNG.uniform(low, high, 40)) for low, high in ((3.0, 9.0), (0.1, 0.3), (1.0, 3.0)))


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize(
    "parameters",
    [
        {},
        {"radius": RADII},
        {"radius": RADII, "beta": BETAS, "mu": 0.7},
        {"radius": RADII, "spacing": SPACINGS},
        {"spacing": 3.0, "sigma": 0.3},
        {"beta": 0.2, "sigma": 0.0},
        {"sigma": 0.3, "normalised": False},
    ],
)
def test_forces_without_edges_are_those_along_them(parameters, m):
    q, p = RNG.uniform(0.0, 20.0, (40, m)), RNG.normal(size=(40, m))
    q[3] = q[4]  # no bearing, and aligned all the same
    q[0] = 500.0  # alone
    law, expected = MinimalFlocking(**parameters), np.zeros((40, m))
    edge_forces(q, p, *law.edge_data(q), expected)
    u, rate = law.flow(0.0, q, p)
    np.testing.assert_allclose(u, expected, rtol=0.0, atol=1e-13 * abs(expected).max())
    assert np.isnan(rate)
    assert not u[0].any()


def test_at_the_desired_spacing_nothing_pulls():
    q, p = np.array([[0.0, 0.0], [49.0, 0.0]]), np.zeros((2, 2))  # 49 (1/49) is not 1
    u, _ = MinimalFlocking(radius=60.0, spacing=49.0).flow(0.0, q, p)
    assert not u.any()
