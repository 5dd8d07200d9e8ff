"""The derivation of a pair law that a user writes: its weight is 2 dψ/d(s²), in either distance."""

import pytest

from flockana.symbolic.pair_derivation import pair_derivation
from flockana.symbolic.pair_formula import read_pair


@pytest.mark.parametrize("potential", ["k*(s**2 - eps)**2", "k*(z - eps)**2"])
def test_the_weight_is_the_slope_of_the_potential_in_either_distance(potential):
    derivation = pair_derivation(read_pair(potential, "", "1", ["k", "eps"]))
    assert derivation.holds
    assert len(derivation.residuals) == 1  # it was computed
