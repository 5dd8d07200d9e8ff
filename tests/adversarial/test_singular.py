"""A singular weight: pairs beside the speed of contact in closed form, and random flocks that never meet."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import SingularAlignment, SingularWeight
from tests.adversarial.cases import VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("singular-alignment", "singular-pair")


@effort(0.5)
@given(powers(-8.0, 0.0), st.booleans(), st.floats(0.1, 0.9), powers(-1.0, 1.0), powers(-2.0, 2.0), powers(-3.0, 3.0))
def test_a_pair_beside_the_speed_of_contact(off, above, decay, start, gain, unit):
    """∫2K (ℓ/s)^α ds from 0 to x ℓ is 2Kℓ x^(1−α)/(1−α)."""
    law = SingularAlignment(SingularWeight(gain, decay, unit))
    bound = 2.0 * gain * unit * start ** (1.0 - decay) / (1.0 - decay)
    speed = bound * (1.0 + off if above else 1.0 / (1.0 + off))
    case = Case(law, [[0.0], [unit * start]], [[0.0], [-speed]], 0.2 * unit * start / speed)
    known = {"meet": VERIFIED, "apart": VACUOUS} if above else {"meet": VACUOUS, "apart": VERIFIED}
    hold("singular-pair", case, known)


@effort(0.4)
@given(st.integers(2, 7), st.floats(0.3, 2.0), powers(-2.0, 1.0), seeds)
def test_strong_weights_keep_all_apart_and_weak_ones_not_from_every_start(n, decay, speed, seed):
    rng = np.random.default_rng(seed)
    case = Case(
        SingularAlignment(SingularWeight(decay=decay)), rng.normal(size=(n, 2)), speed * rng.normal(size=(n, 2)), 0.2
    )
    strong = {"apart": VERIFIED, "some-start": VACUOUS}
    hold("singular-alignment", case, strong if decay >= 1.0 else {"apart": VACUOUS, "some-start": VERIFIED})
