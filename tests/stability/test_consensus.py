"""Delayed consensus: the margin and its roots in closed form, and what is no Laplacian."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from flockana import laplacian
from flockana.base.errors import ArgumentError
from flockana.stability import consensus_root, consensus_system, delay_margin, rightmost_roots


def net(n, pairs, weights=None):
    return laplacian(n, np.array(pairs, dtype=np.int32), weights).toarray()


@pytest.mark.parametrize("seed", range(3))
def test_the_margin_is_that_of_the_largest_eigenvalue(seed):
    rng, pairs = np.random.default_rng(seed), [(0, 1), (1, 2), (2, 3), (3, 4), (0, 2)]
    matrix = net(5, pairs, rng.uniform(0.1, 3.0, len(pairs)))
    found = delay_margin(consensus_system(matrix))
    largest = np.linalg.eigvalsh(matrix)[-1]
    assert (found.delay, found.frequency) == (pytest.approx(pi / (2.0 * largest)), pytest.approx(largest))


@pytest.mark.parametrize("share", [0.3, 0.9, 1.1, 3.0])
def test_the_root_is_one_and_no_other_is_to_its_right(share):
    delay = share * pi / 4.0
    root = consensus_root(2.0, delay)
    assert abs(root + 2.0 * np.exp(-root * delay)) < 1e-13
    found = rightmost_roots(consensus_system(net(2, [(0, 1)])), delay, count=1)[0]
    assert abs(found.real - root.real) < 1e-10
    assert (root.real > 0.0) == (share > 1.0)


def test_roots_at_zero_are_counted_for_each_component():
    assert consensus_system(net(3, [(0, 1), (1, 2)])).neutral == 4
    assert consensus_system(net(3, [(0, 1)])).neutral == 5


@pytest.mark.parametrize(
    ("matrix", "match"),
    [
        ([[1.0, 0.0], [0.0, 1.0]], "rows sum to 0"),
        ([[1.0, -1.0], [-2.0, 2.0]], "symmetric"),
        ([1.0, -1.0], r"shape \(2,\)"),
        ([[float("nan")]], "finite"),
        ("net", "square array of numbers"),
    ],
)
def test_what_is_no_laplacian(matrix, match):
    with pytest.raises(ArgumentError, match=match):
        consensus_system(matrix)


def test_bad_roots():
    with pytest.raises(ArgumentError, match="eigenvalue = 0"):
        consensus_root(0.0, 1.0)
    with pytest.raises(ArgumentError, match="delay = -1"):
        consensus_root(1.0, -1.0)
