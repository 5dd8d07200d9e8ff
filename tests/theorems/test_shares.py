"""Shares of random starts: exact intervals, and what a sample can and cannot decide."""

from __future__ import annotations

import pytest
from scipy.stats import beta

from flockana.theorems.shares import always, interval, mostly, share


def test_shares_have_exact_intervals():
    count, size, ends = share([True] * 7 + [False] * 13)
    assert (count, size) == (7, 20)
    assert ends == interval(7, 20) == pytest.approx((beta.ppf(0.025, 7, 14), beta.ppf(0.975, 8, 13)))


def test_a_sample_never_verifies_always_and_refutes_only_what_it_excludes():
    assert always("x", [True] * 50, "it holds", "always").status == "inconclusive"
    assert always("x", [True] * 19 + [False], "it holds", "always").status == "refuted"
    assert mostly("x", [True] * 20, "it holds", "mostly").status == "verified"
    assert mostly("x", [True] * 3, "it holds", "mostly").status == "inconclusive"
    assert mostly("x", [False] * 20, "it holds", "mostly").status == "refuted"
