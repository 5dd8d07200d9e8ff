"""Erratum J17: the delay is the way between the two radii."""

from __future__ import annotations

import pytest


def test_the_delay_is_the_way_between_the_radii(verdict_of):
    verdict = verdict_of("J17")
    assert verdict.claim("delay").stated == pytest.approx(3.0 / 4.5)
    near, far = verdict.claim("nearer").computed.values()
    assert far - near == pytest.approx(3.0, abs=0.3)  # by about what is seen less
