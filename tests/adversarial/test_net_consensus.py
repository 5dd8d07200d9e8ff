"""Second-order consensus on directed rings and out-trees, beside their threshold in closed form."""

from math import pi, tan

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import NetConsensus
from tests.adversarial.cases import VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("net-consensus",)


@effort(0.4)
@given(st.integers(3, 7), powers(-11.0, 0.0), st.booleans(), st.sampled_from((1e-3, 1.0, 30.0)), seeds)
def test_a_directed_ring_beside_half_the_square_of_its_cotangent(n, off, above, position, seed):
    rng = np.random.default_rng(seed)
    order = rng.permutation(n)
    weights = np.zeros((n, n))
    weights[order, np.roll(order, 1)] = 1.0
    bound = 0.5 / tan(pi / n) ** 2
    velocity = np.sqrt(position * bound * (1.0 + off if above else 1.0 / (1.0 + off)))
    case = Case(NetConsensus(weights, position, velocity), rng.normal(size=(n, 2)), rng.normal(size=(n, 2)), 1.0)
    sides = (VERIFIED, VACUOUS) if above else (VACUOUS, VERIFIED)
    hold("net-consensus", case, dict(zip(("consensus", "some-start"), sides, strict=True)))


@effort(0.4)
@given(st.integers(2, 8), powers(-3.0, 1.0), st.booleans(), seeds)
def test_trees_agree_with_any_gain_and_forests_never(n, velocity, forest, seed):
    """Eigenvalues of a tree are real: the bound is 0."""
    rng = np.random.default_rng(seed)
    weights = np.zeros((n + 1, n + 1))
    for i in range(1, n + 1):
        weights[i, rng.integers(i)] = rng.uniform(0.5, 2.0)
    if forest:
        weights[n] = 0.0
    case = Case(NetConsensus(weights, 1.0, velocity), rng.normal(size=(n + 1, 1)), np.zeros((n + 1, 1)), 1.0)
    sides = (VACUOUS, VERIFIED) if forest else (VERIFIED, VACUOUS)
    hold("net-consensus", case, dict(zip(("consensus", "some-start"), sides, strict=True)))
