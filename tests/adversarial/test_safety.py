"""Starts of filtered pairs and swarms just beside h = 0, on both sides."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import NetConsensus, SafetyFilter
from tests.adversarial.cases import VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers

THEOREMS = ("safety-filter",)


@effort(0.4)
@given(powers(-12.0, -1.0), st.booleans(), powers(-3.0, 3.0), powers(-3.0, 3.0), st.floats(0.1, 3.0), st.integers(2, 4))
def test_a_row_beside_the_speed_at_which_it_can_brake(off, safe, unit, pace, room, n):
    """The first two close in at √(2c(r − D)) times 1 ∓ off; D = unit, α = unit · pace²."""
    law = SafetyFilter(
        NetConsensus(np.ones((n, n)) - np.eye(n), 0.1 * pace**2, 0.0), unit, unit * pace**2, 1.0 / (unit**2 * pace)
    )
    q = unit * np.concatenate([[0.0, 1.0 + room], 1.0 + room + 9.0 * np.arange(1.0, n - 1.0)])[:, None]
    speed = 2.0 * unit * pace * room**0.5 * (1.0 - off if safe else 1.0 + off)
    p = np.zeros((n, 1))
    p[:2, 0] = 0.5 * speed, -0.5 * speed
    side = {"apart": VERIFIED, "braking": VERIFIED} if safe else {"apart": VACUOUS, "braking": VACUOUS}
    known = side | {"too-late": VACUOUS if safe else VERIFIED}
    hold("safety-filter", Case(law, q, p, 0.2 / pace), known)
