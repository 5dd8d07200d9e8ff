"""Sums in lanes, against numpy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.kernels import sums


@given(st.integers(0, 10**6), st.integers(1, 40), st.integers(1, 3))
def test_they_are_the_sums(seed, n, m):
    rng = np.random.default_rng(seed)
    x, v, u = rng.normal(size=(3, n, m))
    row, other = rng.normal(size=(2, m))
    np.testing.assert_allclose(sums.column_means(x), x.mean(axis=0), atol=1e-14)
    assert sums.squared_differences(x, row) == pytest.approx(np.square(x - row).sum(), rel=1e-13)
    expected = u - 0.7 * (x - row) - 1.3 * (v - other)
    sums.pull_to(u, x, v, row, other, 0.7, 1.3)
    np.testing.assert_allclose(u, expected, atol=1e-13)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("where", [0, 7, 12])
def test_one_that_is_not_finite_is_found(bad, where):
    x = np.zeros(13)
    assert sums.finite(x)
    x[where] = bad
    assert not sums.finite(x)
