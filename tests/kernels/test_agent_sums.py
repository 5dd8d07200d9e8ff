"""Sums in lanes, against numpy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.kernels import agent_sums


@given(st.integers(0, 10**6), st.integers(1, 40), st.integers(1, 3))
def test_they_are_the_sums(seed, n, m):
    rng = np.random.default_rng(seed)
    x, v, u = rng.normal(size=(3, n, m))
    row, other = rng.normal(size=(2, m))
    for c in range(m):
        assert agent_sums.column_mean(x, c) == pytest.approx(x[:, c].mean(), abs=1e-14)
        assert agent_sums.column_squares(x, c, row[c]) == pytest.approx(np.square(x[:, c] - row[c]).sum(), rel=1e-13)
    assert agent_sums.squared_deviations(x) == pytest.approx(np.square(x - x.mean(axis=0)).sum(), rel=1e-13, abs=1e-30)
    expected = u - 0.7 * (x - row) - 1.3 * (v - other)
    agent_sums.pull_to(u, x, v, row, other, 0.7, 1.3)
    np.testing.assert_allclose(u, expected, atol=1e-13)


@given(st.integers(0, 10**6), st.integers(2, 200), st.integers(1, 3), st.floats(-1e3, 1e3))
def test_a_slope_is_that_of_least_squares(seed, n, m, place):
    rng = np.random.default_rng(seed)
    x = place + rng.permutation(n)[:, None] + rng.uniform(0.0, 0.5, (n, m))  # no two so near that all is rounding
    y = rng.normal(size=(n, m))
    for c in range(m):
        assert agent_sums.slope_along(x, y, c, 7.0) == pytest.approx(
            np.polyfit(x[:, c] - place, y[:, c], 1)[0], rel=1e-6, abs=1e-9
        )
        assert agent_sums.slope_along(x, 5.0 - 0.7 * x, c, 7.0) == pytest.approx(-0.7, rel=1e-9)


@pytest.mark.parametrize("n", [255, 256, 257, 512, 5000])
def test_a_slope_of_many_is_told_from_some_hundred(n):
    x = np.random.default_rng(n).normal(size=(n, 2))
    assert agent_sums.slope_along(x, 1.0 + 0.3 * x, 1, 7.0) == pytest.approx(0.3, rel=1e-12)
    assert agent_sums.slope_along(x[:1], x[:1], 0, 7.0) == 7.0
    assert agent_sums.slope_along(np.ones((n, 1)), x, 0, 7.0) == 7.0
    assert agent_sums.slope_along(1e200 * x, 1e200 * x, 0, 7.0) == 7.0  # squares beyond all numbers
    assert agent_sums.slope_along(x, np.full((n, 1), np.nan), 0, 7.0) == 7.0


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("where", [0, 7, 12])
def test_one_that_is_not_finite_is_found(bad, where):
    x = np.zeros(13)
    assert agent_sums.finite(x)
    x[where] = bad
    assert not agent_sums.finite(x)
