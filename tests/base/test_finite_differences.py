"""Differences of order 6: exact for polynomials, close for others, and honest at kinks and jumps."""

import numpy as np
import pytest

from flockana.base.finite_differences import differences


def test_polynomials_up_to_the_sixth_power_are_exact():
    x = np.array([[0.3, -1.2], [2.0, 0.7]])
    found = differences(lambda y: y**6, x, 1.0)
    np.testing.assert_allclose(found.matrix, np.diag(6.0 * x.ravel() ** 5), rtol=1e-9, atol=1e-9)
    assert found.spread < 1e-9


def test_the_width_shrinks_until_two_agree():
    """A function that bends within 1e-3 of its unit: wide differences see another slope."""
    found = differences(lambda y: np.tanh(1e3 * y), np.array([2e-4]), 1.0)
    assert found.matrix[0, 0] == pytest.approx(1e3 / np.cosh(0.2) ** 2, rel=1e-7)
    assert found.spread < 1e-6


@pytest.mark.parametrize("function", [np.abs, np.sign, lambda y: y + np.maximum(y, 0.0)])
def test_kinks_and_jumps_are_told(function):
    assert differences(function, np.zeros(1), 1.0).spread > 0.1
