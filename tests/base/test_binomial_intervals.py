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


@given(st.integers(1, 60).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))), st.floats(0.5, 0.999))
def test_each_end_makes_the_count_a_tail(counts, level):
    k, n = counts
    low, high = (float(end) for end in clopper_pearson(k, n, level=level))
    assert low <= k / n <= high
    if k > 0:
        assert binom.sf(k - 1, n, low) == pytest.approx(0.5 * (1.0 - level), rel=1e-9)
    if k < n:
        assert binom.cdf(k, n, high) == pytest.approx(0.5 * (1.0 - level), rel=1e-9)


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
