"""Collisions avoided: random flocks that start farther apart than δ, and such as do not."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import CuckerDong, RationalWeight
from tests.adversarial.cases import VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("cucker-dong",)


@effort(0.4)
@given(st.integers(2, 5), powers(-2.0, 1.0), powers(-1.0, 1.0), st.booleans(), powers(-1.0, 0.0), seeds)
def test_flocks_beside_the_distance(n, repulsion, speed, apart, off, seed):
    """On a line with gaps of δ (1 ± off) at least."""
    rng = np.random.default_rng(seed)
    gaps = rng.uniform(1.5, 3.0, n - 1)
    gaps[0] = 1.0 + off if apart else 1.0 - 0.9 * off
    q = np.concatenate([[0.0], np.cumsum(gaps)])[:, None]
    law = CuckerDong(RationalWeight(decay=0.25), repulsion)
    case = Case(law, q, speed * rng.normal(size=(n, 1)), 1e-3)
    told = VERIFIED if apart else VACUOUS
    hold("cucker-dong", case, dict.fromkeys(("apart", "bounded", "flock"), told))
