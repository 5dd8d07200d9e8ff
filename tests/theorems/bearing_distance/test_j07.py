"""Erratum J7: the largest speed that the printed bound lets a flock keep."""

from math import tanh

import numpy as np
import pytest

from flockana.theorems.bearing_distance.j07 import dragged_speed


def test_the_drag():
    assert dragged_speed(0.1) == pytest.approx(2.0083, abs=5e-5)
    speeds = [dragged_speed(dt) for dt in (0.05, 0.01, 0.001)]
    np.testing.assert_allclose(speeds, [1.628, 0.974, 0.457], atol=1e-3)  # found by iteration, to three digits
    v = dragged_speed(0.1)
    assert 4.0 * tanh((v + 0.2) / 4.0) == pytest.approx(v, abs=1e-12)
