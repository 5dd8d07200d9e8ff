"""Two agents with averaged headings: whether they ever agree is known by algebra, far above and below rounding."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana.sources.vicsek_1995.laws import HeadingAveraging
from tests.adversarial import truth
from tests.adversarial.cases import OPEN, TRUE, VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers

THEOREMS = ("jlm-headings",)
UNTIL = 12


@effort(1.0)
@given(powers(-6.0, 0.5), st.sampled_from((-1.0, 1.0)), *[st.floats(0.1, 6.0)] * 2, st.sampled_from((1e-3, 1.0, 1e4)))
def test_two_agents_agree_if_they_ever_meet(off, side, one, other, unit):
    """Two agents at (1 + side·off) r; headings anywhere but near the direction that they are counted from."""
    apart = abs(1.0 + side * off)
    law = HeadingAveraging(range=unit, speed=0.2 * unit, dt=1.0)
    q = unit * np.array([[0.0, 0.0], [apart, 0.0]])
    case = Case(law, q, law.velocities([one, other]), float(UNTIL))
    meets, sure, room = truth.two_headings(apart, one, other, 0.2, UNTIL)
    known = (VERIFIED if room > 1e-9 else TRUE) if meets else VACUOUS if room > 1e-2 else OPEN
    said = {"agreement": known if sure else TRUE | OPEN, "contraction": VERIFIED if sure and meets else TRUE}
    hold("jlm-headings", case, {"hull": VERIFIED} | said)
