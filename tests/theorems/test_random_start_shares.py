"""Shares of random starts: exact intervals, and what a sample can and cannot decide."""

import pytest
from scipy.stats import beta

from flockana.theorems.random_start_shares import always, interval, mostly

YES, NO, OPEN = [True], [False], [None]


@pytest.mark.parametrize("undecided", [0, 4])  # which count against the lower end and for the upper one
def test_shares_have_exact_intervals(undecided):
    above = 8 + undecided
    ends = beta.ppf(0.025, 7, 14), beta.ppf(0.975, above, 20 - above + 1)
    assert interval(7, 20, undecided=undecided) == pytest.approx(ends)


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
        (20 * YES, "verified"), (20 * YES + 5 * OPEN, "verified"), (20 * YES + 15 * OPEN, "inconclusive"),
        (3 * YES, "inconclusive"), (20 * NO, "refuted"), (20 * NO + 5 * OPEN, "refuted"),
        (20 * NO + 15 * OPEN, "inconclusive"),
    ],
)  # fmt: skip
def test_mostly(outcomes, status):
    claim = mostly("x", outcomes, "it holds", "mostly")
    assert claim.status == status
    ends = interval(outcomes.count(True), len(outcomes), undecided=outcomes.count(None))
    assert claim.computed == {"holds": outcomes.count(True), "of": len(outcomes), "share": ends}
    assert ("undecided" in claim.detail) == (None in outcomes)
