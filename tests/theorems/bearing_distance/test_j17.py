"""Erratum J17: the first step of what never happens."""

import numpy as np

from flockana.theorems.bearing_distance.j17 import first_step


def test_what_never_happens_has_no_first_step():
    """Its number would be 0 by argmax, and two such would have no delay."""
    assert first_step(np.array([False, False, True, True])) == 2.0
    assert np.isnan(first_step(np.zeros(3, dtype=bool)))
