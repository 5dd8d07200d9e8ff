"""Quantiles of the distances of all pairs, against a sort of them in plain loops."""

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from flockana.measures.distance_profiles import pair_distance_profile
from flockana.measures.metrics import min_distance
from tests.refused import refused


def test_quantiles_of_all_pairs():
    q = np.random.default_rng(0).uniform(0.0, 9.0, (3, 7, 2))
    found = pair_distance_profile(q)
    for k in range(3):
        apart = sorted(float(np.hypot(*(q[k, i] - q[k, j]))) for i in range(7) for j in range(i))
        assert len(apart) == 21  # quarters of 20 steps fall on distances of their own
        np.testing.assert_allclose(found[k], [apart[0], apart[5], apart[10], apart[15], apart[20]], rtol=1e-14)
        assert found[k, 0] == pytest.approx(min_distance(q[k]), rel=1e-14)


def test_one_agent_has_no_distances():
    assert np.isnan(pair_distance_profile(np.zeros((4, 1, 3)))).all()
    assert pair_distance_profile(np.zeros((4, 1, 3))).shape == (4, 5)


@pytest.mark.parametrize(("n", "count"), [(8, 5000), (700, 3)])
def test_instants_in_blocks_are_those_one_by_one(n, count):
    """More of them than are held at once, and more pairs at one instant."""
    q, shares = np.random.default_rng(n).normal(size=(count, n, 2)), (0.0, 0.3, 1.0)
    expected = [np.quantile(pdist(instant), shares) for instant in q]
    np.testing.assert_array_equal(pair_distance_profile(q, shares), expected)


test_bad_arguments = refused(
    (lambda: pair_distance_profile(np.zeros((2, 2))), r"q has shape \(2, 2\): expected \(T, n, m\)"),
    (lambda: pair_distance_profile("ab"), "q = 'ab': expected numbers, in arrays"),
    (lambda: pair_distance_profile([[["a"]]]), "expected numbers, in arrays"),
    (lambda: pair_distance_profile([[[0.0], [1.0, 2.0]]]), "expected numbers, in arrays"),
    (lambda: pair_distance_profile(np.zeros((1, 2, 2)), (0.5, 1.5)), "expected numbers from 0 to 1"),
    (lambda: pair_distance_profile(np.zeros((1, 2, 2)), (-0.5, 0.5)), "expected numbers from 0 to 1"),
)
