"""The α-interaction in other units: lengths follow, and a time is no part of it."""

import pytest

from flockana import AlphaInteraction, rescale


def test_lengths_follow_the_unit_and_times_do_nothing():
    pair = AlphaInteraction(d=6.0, r=7.5)
    assert rescale(pair, time=0.25) == pair
    longer = rescale(pair, length=3.0)
    assert (longer.length, longer.range) == (18.0, 22.5)
    assert longer.energy_at(3.0 * 5.0) == pytest.approx(9.0 * pair.energy_at(5.0), rel=1e-12)  # c1α is 1/time²
