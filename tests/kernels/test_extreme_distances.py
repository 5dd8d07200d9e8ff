"""Least and greatest distances at many instants, against all of them."""

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from flockana.kernels.extreme_distances import greatest_distances, least_distances


def ring(n):
    angles = 2.0 * np.pi * np.arange(n) / n
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


FLOCKS = {
    "a cloud": lambda rng, n, m: rng.normal(size=(n, m)),
    "a box": lambda rng, n, m: rng.uniform(size=(n, m)),
    "a box far away": lambda rng, n, m: 1e6 + rng.uniform(size=(n, m)),
    "two flocks": lambda rng, n, m: rng.normal(size=(n, m)) + 30.0 * (np.arange(n) % 7 == 0)[:, None],
    "one astray": lambda rng, n, m: rng.normal(size=(n, m)) + 1e5 * (np.arange(n) == 3)[:, None],
    "one place": lambda rng, n, m: np.ones((n, m)),
    "a line": lambda rng, n, m: np.outer(rng.normal(size=n), np.ones(m)),
    "all on the rim": lambda rng, n, m: np.pad(ring(n) * rng.normal(1.0, 0.01, (n, 1)), ((0, 0), (0, 1)))[:, :m],
    "a triangle of three flocks": lambda rng, n, m: (
        np.pad(100.0 * ring(3), ((0, 0), (0, 1)))[np.arange(n) % 3, :m] + rng.uniform(size=(n, m))
    ),
}


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("flock", FLOCKS)
def test_they_are_those_of_all_pairs_to_the_bit(flock, m):
    for n, instants in ((2, 60), (5, 60), (300, 10)):
        rng = np.random.default_rng(n)
        q = np.array([FLOCKS[flock](rng, n, m) for _ in range(instants)])
        gaps = [np.sqrt(np.square(x[:, None] - x[None]).sum(axis=2))[np.triu_indices(n, 1)] for x in q]
        np.testing.assert_array_equal(greatest_distances(q), [each.max() for each in gaps])
        np.testing.assert_array_equal(least_distances(q), [each.min() for each in gaps])


def test_one_agent_is_no_distance_from_itself_and_infinitely_far_from_others():
    q = np.ones((4, 1, 2))
    assert greatest_distances(q).tolist() == [0.0] * 4
    assert least_distances(q).tolist() == [np.inf] * 4


def test_of_a_large_flock_too():
    q = np.random.default_rng(0).normal(size=(1, 4000, 2))
    assert greatest_distances(q)[0] == pytest.approx(pdist(q[0]).max(), rel=1e-15)
