"""Lengths and means of short vectors, against numpy's own, to the bit."""

import numpy as np
import pytest

from flockana.base.vector_norms import centres, lengths, scaled_near_one

SHAPES = [(1, 1, 2), (1, 300, 3), (7, 1, 1), (40, 150, 1), (40, 150, 2), (33, 40, 3), (5, 0, 2), (0, 4, 2)]


def some(shape):
    rng = np.random.default_rng(sum(shape))
    return rng.normal(size=shape) * 10.0 ** rng.integers(-6, 6, shape)


@pytest.mark.parametrize("shape", SHAPES)
def test_lengths_are_numpys(shape):
    x = some(shape)
    np.testing.assert_array_equal(lengths(x), np.linalg.norm(x, axis=2))
    np.testing.assert_array_equal(lengths(x[:, ::2]), np.linalg.norm(x[:, ::2], axis=2))
    for one in x:
        np.testing.assert_array_equal(lengths(one), np.linalg.norm(one, axis=1))


@pytest.mark.parametrize("shape", [shape for shape in SHAPES if shape[1]])
def test_centres_are_numpys(shape):
    x = some(shape)
    np.testing.assert_array_equal(centres(x), x.mean(axis=1))
    np.testing.assert_array_equal(centres(x[:, : (shape[1] + 1) // 2]), x[:, : (shape[1] + 1) // 2].mean(axis=1))


def test_what_is_given_is_left_as_it_is():
    x = some((6, 5, 2))
    before = x.copy()
    lengths(x)
    centres(x)
    np.testing.assert_array_equal(x, before)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e200])
def test_what_is_not_finite_or_overflows_shows(bad):
    x = np.ones((1, 4, 3))
    x[0, 2, 1] = bad
    with np.errstate(over="ignore", invalid="ignore"):
        np.testing.assert_array_equal(lengths(x), np.linalg.norm(x, axis=2))
        np.testing.assert_array_equal(centres(x), x.mean(axis=1))


def test_numbers_whose_squares_overflow_are_scaled_by_a_power_of_two():
    x, (r,), unit = scaled_near_one(np.array([3.0, 4.0]) * 2.0**600, 2.0**599)
    assert (x.tolist(), r, unit) == ([0.75, 1.0], 0.125, 2.0**602)
    assert scaled_near_one(np.array([3.0]), 2.0)[2] == 1.0
