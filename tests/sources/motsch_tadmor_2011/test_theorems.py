"""The theorems on own sums: thresholds in closed form, bounds of runs, and influences that fall slowly."""

from math import pi

import numpy as np
import pytest

import flockana as fl
from flockana import MotschTadmor, RationalWeight, verify

STEEP = MotschTadmor(RationalWeight(decay=1.0))
PAIR = [[0.0], [1.0]]


def test_the_bounds_are_those_of_the_integral_in_any_unit():
    """Speed 0.5 from 1: atan x_M = π/4 + 1/2 for φ."""
    for length, time in ((1.0, 1.0), (1e3, 1e-3)):
        law = fl.rescale(STEEP, length=length, time=time)
        start = length * np.array(PAIR), length / time * np.array([[0.0], [0.5]])
        verdict = verify("motsch-tadmor-sharp", law=law, q0=start[0], p0=start[1], t_span=(0.0, 8.0 * time))
        x_m = length * np.tan(pi / 4.0 + 0.5)
        assert verdict.claim("bounded").stated.endswith(f"{x_m:.6g}")
        assert verdict.claim("bounded").margin == pytest.approx(1.0 - verdict.claim("bounded").computed / x_m, rel=1e-4)
