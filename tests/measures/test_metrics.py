"""Metrics: exact facts by hand."""

import numpy as np
import pytest

from flockana.measures import metrics
from tests.refused import refused

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def test_deviation_energy_counts_ordered_pairs():
    """Four sides of 2 against d = 1.5: eight ordered pairs of 0.25, over 8 + 1."""
    assert metrics.deviation_energy(SQUARE, d=1.5, r=2.5) == pytest.approx(2.0 / 9.0, rel=1e-15)
    assert metrics.deviation_energy(SQUARE, d=2.0, r=2.5) == 0.0
    assert metrics.deviation_energy(SQUARE, d=2.0, r=2.0) == 0.0  # no links: 0/1


def test_deviation_energy_of_a_quasi_lattice_stays_below_delta_squared():
    rng = np.random.default_rng(0)
    q = np.arange(30.0)[:, None] * 7.0 + rng.uniform(-0.1, 0.1, (30, 1))
    assert 0.0 < metrics.deviation_energy(q, 7.0, 8.4) <= 0.2**2


def test_connectivity_and_giant_share():
    q = np.array([[0.0], [1.0], [2.0], [10.0], [11.0], [30.0]])
    assert metrics.connectivity(q, 1.5) == 3 / 5
    assert metrics.giant_share(q, 1.5) == 0.5
    assert metrics.net_measures([[5.0, 5.0]], 1.0, 2.0) == (1.0, 1.0, 0.0)
    assert metrics.net_measures(np.zeros((2, 3)), 1.0, 2.0) == (1.0, 1.0, pytest.approx(2 / 3))


def test_radius_inertia_mismatch():
    assert metrics.cohesion_radius(SQUARE) == pytest.approx(np.sqrt(2.0), rel=1e-15)
    assert metrics.inertia(SQUARE) == 4.0
    assert metrics.velocity_mismatch(SQUARE + 1e6) == 4.0
    assert metrics.cohesion_radius([[3.0, 4.0]]) == metrics.inertia([[3.0, 4.0]]) == 0.0
    assert metrics.cohesion_radius([[0.0], [0.0], [3.0]]) == 2.0


def test_min_distance():
    assert metrics.min_distance(SQUARE) == 2.0
    assert metrics.min_distance([[1.0, 1.0]]) == np.inf
    assert metrics.min_distance(np.ones((40, 3))) == 0.0
    assert metrics.min_distance(np.array([[0.0], [5.0], [5.0 + 1e-9], [1e13]])) == pytest.approx(1e-9, rel=1e-6)
    q = np.random.default_rng(0).uniform(0.0, 50.0, (300, 3))
    i, j = np.triu_indices(300, 1)
    assert metrics.min_distance(q) == pytest.approx(np.linalg.norm(q[i] - q[j], axis=1).min(), rel=1e-15)


@pytest.mark.parametrize(("n", "m"), [(1, 2), (2, 1), (7, 2), (7, 3), (310, 2)])
def test_over_time_they_are_what_their_formulas_say(n, m):
    """Against loops over agents and pairs; 310 agents are searched by a tree."""
    rng = np.random.default_rng(n)
    x, p = rng.normal(3.0, 2.0, (3, n, m)), rng.normal(0.0, 1.0, (3, n, m))
    p[1, 0] = 0.0  # at rest
    for k in range(3):
        centred = x[k] - sum(x[k]) / n
        lengths = [np.linalg.norm(one) for one in centred]
        assert metrics.cohesion_radii(x)[k] == pytest.approx(max(lengths), rel=1e-13, abs=1e-13)
        assert metrics.spreads(x)[k] == pytest.approx(0.5 * sum(one**2 for one in lengths), rel=1e-13, abs=1e-13)
        pairs = [np.linalg.norm(x[k, i] - x[k, j]) for i in range(n) for j in range(i)]
        assert metrics.min_distances(x)[k] == pytest.approx(min(pairs, default=np.inf), rel=1e-15)
        heading = [v / np.linalg.norm(v) for v in p[k] if v.any()]
        assert metrics.orders(p)[k] == pytest.approx(np.linalg.norm(sum(heading, np.zeros(m))) / n, abs=1e-13)
        cosines = [a @ b for i, a in enumerate(heading) for b in heading[:i]]
        mean = np.mean(cosines) if cosines else np.nan
        assert metrics.coordinations(p)[k] == pytest.approx(mean, abs=1e-12, nan_ok=True)


@pytest.mark.parametrize("unit", [2.0**-1000, 2.0**-560, 2.0**-470, 2.0**500, 2.0**600, 2.0**1000])
def test_directions_hang_on_no_unit_however_small_or_large(unit):
    """A flock that comes to rest has speeds whose squares are 0."""
    p = np.random.default_rng(0).normal(size=(12, 2))
    p[3] = 0.0
    assert metrics.order(unit * p) == pytest.approx(metrics.order(p), rel=1e-15)
    assert metrics.coordination(unit * p) == pytest.approx(metrics.coordination(p), rel=1e-13)
    mixed = np.array([[unit, 0.0], [1.0, 0.0], [0.0, 0.0]])
    assert (metrics.order(mixed), metrics.coordination(mixed)) == (2.0 / 3.0, 1.0)


def test_coincident_pairs():
    q = np.array([[0.0, 0.0]] * 4 + [[1.0, 0.0], [1.0, 1e-7]])
    assert metrics.coincident_pairs(q, 1e-9) == 6
    assert metrics.coincident_pairs(q, 1e-6) == 7
    assert metrics.coincident_pairs(q, 1e-200) == 6


test_refusals = refused((lambda: metrics.coincident_pairs(SQUARE, 0.0), "tol = 0: expected a number > 0"), exact=True)
