import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom, binomtest

from flockana.base.errors import ArgumentError
from flockana.ensemble import clopper_pearson


@pytest.mark.parametrize(("k", "n"), [(0, 1), (0, 200), (1, 3), (57, 200), (199, 200), (200, 200)])
@pytest.mark.parametrize("level", [0.8, 0.95, 0.999])
def test_ends_agree_with_scipys_exact_interval(k, n, level):
    found = binomtest(k, n).proportion_ci(level, "exact")
    np.testing.assert_allclose(clopper_pearson(k, n, level=level), (found.low, found.high), rtol=1e-10, atol=1e-300)


def test_the_ends_without_a_tail_in_closed_form():
    """0 of n: the upper end p solves (1 − p)^n = α/2."""
    low, high = clopper_pearson([0, 10], [10, 10], level=0.9)
    np.testing.assert_allclose(high, [1.0 - 0.05**0.1, 1.0], rtol=1e-14)
    np.testing.assert_allclose(low, [0.0, 0.05**0.1], rtol=1e-14)


@given(st.integers(1, 60).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))), st.floats(0.5, 0.999))
def test_each_end_makes_the_count_a_tail(counts, level):
    k, n = counts
    low, high = (float(end) for end in clopper_pearson(k, n, level=level))
    assert low <= k / n <= high
    if k > 0:
        assert binom.sf(k - 1, n, low) == pytest.approx(0.5 * (1.0 - level), rel=1e-9)
    if k < n:
        assert binom.cdf(k, n, high) == pytest.approx(0.5 * (1.0 - level), rel=1e-9)


def test_coverage_is_at_least_the_level():
    n, level = 25, 0.9
    low, high = clopper_pearson(np.arange(n + 1), n, level=level)
    for p in np.linspace(0.01, 0.99, 33):
        covered = (low <= p) & (p <= high)
        assert binom.pmf(np.arange(n + 1), n, p)[covered].sum() >= level


def test_of_no_trials_nothing_follows():
    assert [float(end) for end in clopper_pearson(0, 0)] == [0.0, 1.0]


@pytest.mark.parametrize(("k", "n"), [(-1, 3), (4, 3), ([1, np.nan], 3), (1.5, 3), (1, 2.5), (3, np.inf)])
def test_impossible_counts_are_refused(k, n):
    with pytest.raises(ArgumentError, match="0 <= successes <= trials"):
        clopper_pearson(k, n)


@pytest.mark.parametrize("level", [0.0, 1.0, 95.0, float("nan")])
def test_a_level_is_no_percentage(level):
    with pytest.raises(ArgumentError, match="level"):
        clopper_pearson(1, 2, level=level)
