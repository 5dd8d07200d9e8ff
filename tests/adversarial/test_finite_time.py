"""Agreement in a finite time: a pair that attains the bound, random nets, and nets in parts."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import FiniteTimeAlignment
from tests.adversarial.cases import VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("finite-time",)
AGREES = {"bound": VERIFIED, "settle": VERIFIED, "some-start": VACUOUS}


@effort(0.4)
@given(st.floats(0.1, 0.9), powers(-2.0, 2.0), powers(-3.0, 3.0), powers(-3.0, 3.0))
def test_a_pair_attains_the_bound(exponent, gain, speed, start):
    """T = (w/s)^(1−α)/(2a(1−α))."""
    law = FiniteTimeAlignment(((0, 1),), gain, exponent, speed)
    end = start ** (1.0 - exponent) / (2.0 * gain * (1.0 - exponent))
    hold("finite-time", Case(law, [[0.0], [1.0]], [[0.0], [start * speed]], 0.7 * end), AGREES)


@effort(0.4)
@given(st.integers(2, 6), st.floats(0.3, 1.0), st.booleans(), seeds)
def test_random_trees_and_trees_without_a_link(n, exponent, parted, seed):
    rng = np.random.default_rng(seed)
    links = [(int(rng.integers(k)), k) for k in range(1, n)][parted:]
    law = FiniteTimeAlignment(links, exponent=exponent)
    case = Case(law, rng.normal(size=(n, 1)), np.cumsum(rng.uniform(1.0, 2.0, (n, 1)), axis=0), 0.1)
    never = {"settle": VACUOUS, "some-start": VERIFIED}
    hold("finite-time", case, never if parted or exponent == 1.0 else AGREES)
