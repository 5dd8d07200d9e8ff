"""Erratum J17: the delay is the way between the two radii."""

import numpy as np
import pytest

from flockana.theorems.bearing_distance.j17 import first_step


def test_the_delay_is_the_way_between_the_radii(verdict_of):
    verdict = verdict_of("J17")
    assert verdict.claim("delay").stated == pytest.approx(3.0 / 4.5)
    near, far = verdict.claim("nearer").computed.values()
    assert far - near == pytest.approx(3.0, abs=0.3)  # by about what is seen less


def test_what_never_happens_has_no_first_step():
    """Its number would be 0 by argmax, and two such would have no delay."""
    assert first_step(np.array([False, False, True, True])) == 2.0
    assert np.isnan(first_step(np.zeros(3, dtype=bool)))
