"""Shares of random starts: exact intervals, and what a sample can and cannot decide."""

import pytest
from scipy.stats import beta

from flockana.theorems.shares import always, interval, mostly, share

YES, NO, OPEN = [True], [False], [None]


def test_shares_have_exact_intervals():
    count, size, ends = share(7 * YES + 13 * NO)
    assert (count, size) == (7, 20)
    assert ends == interval(7, 20) == pytest.approx((beta.ppf(0.025, 7, 14), beta.ppf(0.975, 8, 13)))


def test_undecided_seeds_count_against_the_lower_end_and_for_the_upper_one():
    count, size, ends = share(7 * YES + 9 * NO + 4 * OPEN)
    assert (count, size) == (7, 20)
    assert ends == pytest.approx((beta.ppf(0.025, 7, 14), beta.ppf(0.975, 12, 9)))


@pytest.mark.parametrize(
    ("outcomes", "status"),
    [
        (50 * YES, "inconclusive"),  # a sample never verifies that something always holds
        (19 * YES + NO, "refuted"),
        (19 * YES + OPEN, "inconclusive"),
        (18 * YES + OPEN + NO, "refuted"),
    ],
)
def test_always(outcomes, status):
    claim = always("x", outcomes, "it holds", "always")
    assert (claim.status, claim.about) == (status, "all")


@pytest.mark.parametrize(
    ("outcomes", "status"),
    [
        (20 * YES, "verified"),
        (20 * YES + 5 * OPEN, "verified"),
        (20 * YES + 15 * OPEN, "inconclusive"),
        (3 * YES, "inconclusive"),
        (20 * NO, "refuted"),
        (20 * NO + 5 * OPEN, "refuted"),
        (20 * NO + 15 * OPEN, "inconclusive"),
    ],
)
def test_mostly(outcomes, status):
    claim = mostly("x", outcomes, "it holds", "mostly")
    assert claim.status == status
    assert claim.computed == {"holds": outcomes.count(True), "of": len(outcomes), "share": share(outcomes)[2]}
    assert ("undecided" in claim.detail) == (None in outcomes)
