"""Hexagonal spirals and Harborth's number."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flockana.errors import ArgumentError
from flockana.lattice import harborth, hexagonal_patch, hexagonal_spiral
from flockana.metrics import min_distance
from flockana.nets import link_lengths, links


def test_harborth_by_hand():
    """1: none; 2: one; 3: a triangle; 4: a rhombus; 7, 19, 37: full hexagons, whose links are counted by degrees."""
    assert [harborth(n) for n in (1, 2, 3, 4, 7, 19, 37)] == [0, 1, 3, 5, 12, 42, 90]


@pytest.mark.parametrize("n", [1, 2, 3, 12, 37, 1000, 10**12])
def test_harborth_is_the_floor_even_where_floats_fail(n):
    root = math.isqrt(12 * n - 3)
    exact = 3 * n - root - (root * root != 12 * n - 3)
    assert harborth(n) == exact


@pytest.mark.parametrize("n", range(1, 80))
def test_the_spiral_is_a_lattice_with_the_most_links(n):
    q = hexagonal_spiral(n, 7.0)
    pairs = links(q, 8.4)
    assert len(pairs) == harborth(n)
    np.testing.assert_allclose(link_lengths(q, pairs), 7.0, rtol=1e-13)
    assert n == 1 or min_distance(q) == pytest.approx(7.0, rel=1e-13)


def test_a_patch_is_a_full_spiral():
    assert [len(hexagonal_patch(k, 1.0)) for k in range(4)] == [1, 7, 19, 37]
    q = hexagonal_patch(2, 1.0)
    np.testing.assert_allclose(q.mean(axis=0), 0.0, atol=1e-14)


@pytest.mark.parametrize("n", [0, -1, 2.5, True, "7"])
def test_bad_counts_are_named(n):
    with pytest.raises(ArgumentError, match="expected a whole number >= 1"):
        hexagonal_spiral(n, 7.0)
