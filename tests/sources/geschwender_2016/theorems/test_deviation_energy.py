"""The deviation energy's jump and corner by hand, and the potential's lack of both."""

import pytest

from flockana import plots


def test_the_numbers_by_hand(verdict_of):
    """d = 7, r = 8.4: ⅔·1.4² = 1.3067 at the range; the slope ⅔·2·7 on either side of coincidence, 56/3 together."""
    verdict = verdict_of("deviation-energy")
    assert verdict.claim("jump").computed == pytest.approx(2.0 / 3.0 * 1.4**2, rel=1e-4)
    assert verdict.claim("corner").computed == pytest.approx(56.0 / 3.0, rel=1e-5)
    assert abs(verdict.claim("potential-continuous").computed) < 1e-9
    assert abs(verdict.claim("potential-smooth").computed) < 1e-3
    assert {claim.proof for claim in verdict.claims} == {"deviation-energy"}


def test_the_picture_leaves_a_gap_at_the_range():
    from flockana import AlphaInteraction

    ax = plots.deviation(AlphaInteraction())
    ends = [line for line in ax.lines if line.get_marker() == "o"]
    drawn = [(line.get_xdata()[0], line.get_markerfacecolor() == "white") for line in ends]
    assert drawn == [(8.4, True), (8.4, False)]
    assert ends[0].get_ydata()[0] == pytest.approx((1.4 / 7.0) ** 2)
    assert ends[1].get_ydata()[0] == 0.0
