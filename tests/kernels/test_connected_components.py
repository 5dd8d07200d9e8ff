"""Components by union-find are those that scipy finds, in the same order, whatever the order and parts of the links."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from flockana.kernels.connected_components import labelled, squared_excess, unite


@pytest.mark.parametrize("seed", range(20))
def test_they_are_scipys(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 60))
    first, second = rng.integers(0, n, (2, int(rng.integers(0, n + 1)))).astype(np.int32)
    known, half = np.arange(n), first.size // 2
    unite(known, first[half:], second[half:])
    unite(known, second[:half], first[:half])
    graph = coo_array((np.ones(first.size), (first, second)), shape=(n, n))
    assert labelled(known).tolist() == connected_components(graph, directed=False)[1].tolist()


def test_a_chain_that_is_told_from_its_far_end():
    known = np.arange(5)
    unite(known, np.array([4, 3, 1], np.int32), np.array([3, 2, 0], np.int32))
    assert labelled(known).tolist() == [0, 0, 1, 1, 1]


def test_the_excess_of_links():
    q, first, second = np.array([[0.0, 0.0], [3.0, 4.0], [0.0, 2.0]]), np.array([0, 0], np.int32), np.array([1, 2])
    assert squared_excess(q, first, second.astype(np.int32), 1.5) == 3.5**2 + 0.5**2
