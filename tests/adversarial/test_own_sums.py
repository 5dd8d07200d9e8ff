"""Own sums: pairs beside their thresholds in closed form, and random flocks whose diameters bound each other."""

from math import atan, pi

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import MotschTadmor, RationalWeight
from tests.adversarial.cases import VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("motsch-tadmor", "motsch-tadmor-sharp")
CLAIMS = ("bounded", "rate", "flock")


@effort(0.5)
@given(powers(-8.0, 0.0), st.booleans(), st.floats(0.2, 5.0), powers(-2.0, 2.0), powers(-3.0, 3.0), st.booleans())
def test_a_pair_beside_its_threshold(off, above, start, gain, unit, square):
    """Beyond s/ℓ = x: ∫φ is ℓ (π/2 − atan x) and ∫φ² half of ℓ (π/2 − atan x − x/(1 + x²)), φ = 1/(1 + x²)."""
    tail = pi / 2.0 - atan(start)
    bound = gain * unit * (0.5 * (tail - start / (1.0 + start**2)) if square else tail)
    speed = bound * (1.0 + off if above else 1.0 / (1.0 + off))
    law = MotschTadmor(RationalWeight(decay=1.0, length=unit), gain=gain)
    case = Case(law, unit * np.array([[0.0], [start]]), np.array([[0.0], [speed]]), 1.0 / gain)
    told = VACUOUS if above else VERIFIED
    known = dict.fromkeys(("flock",) if not above else CLAIMS, told)
    hold("motsch-tadmor" if square else "motsch-tadmor-sharp", case, known)


@effort(0.4)
@given(st.integers(2, 9), st.floats(0.0, 0.5), powers(-3.0, 2.0), seeds)
def test_slow_influences_make_every_start_a_flock(n, decay, speed, seed):
    rng = np.random.default_rng(seed)
    law = MotschTadmor(RationalWeight(decay=decay))
    case = Case(law, rng.normal(size=(n, 2)), speed * rng.normal(size=(n, 2)), 1.0)
    hold("motsch-tadmor-sharp", case, {"flock": VERIFIED})
