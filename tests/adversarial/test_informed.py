"""Few informed agents, leaders of varying velocity, and cohesion under compositions, against planted motions.

One agent that feels a leader alone is a damped spring: it is where `truth.harmonic` says, never reaches its bound, and
nobody else follows. Where nothing damps, it touches the bound, and no verdict may call that too far.
"""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import Algorithm2, AlphaInteraction, CircleTarget, Composition, Gains, LinearTarget, StaticTarget
from tests.adversarial import truth
from tests.adversarial.cases import TRUE, VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import seeds

THEOREMS = ("cohesion", "su-informed", "su-varying")
COLLISIONS = ("pairs", "one-instant", "no-collision")


@effort(0.4)
@given(
    st.sampled_from((0.05, 1.0, 20.0)), st.sampled_from((0.0, 0.3, 1.0, 3.0)), st.sampled_from((None, 0.2, 5.0)), seeds
)
def test_one_agent_on_a_spring_stays_within_its_energy(pull, zeta, unit, seed):
    """Without damping it comes back to the bound at rest, so the margin is 0: never refuted, whatever rounding does."""
    rng = np.random.default_rng(seed)
    gains = Gains(0.0, 0.0, 0.0, 0.0, (pull,), (2.0 * zeta * np.sqrt(pull),))
    law = Composition(None, gains, target=StaticTarget((0.0, 0.0)), unit=unit)
    at_rest = rng.random() < 0.5
    q, p = 5.0 * rng.normal(size=(1, 2)), (0.0 if at_rest else 2.0) * rng.normal(size=(1, 2))
    clear = zeta >= 0.3 and not at_rest
    hold("cohesion", Case(law, q, p, 8.0 / np.sqrt(pull)), {"bound": VERIFIED if clear else TRUE})


@effort(0.2)
@given(st.sampled_from((0.3, 1.0, 3.0)), st.sampled_from((0.5, 1.0, 1.5)), st.booleans(), seeds)
def test_who_is_informed_follows_and_who_is_far_does_not(pull, zeta, moving, seed):
    rng = np.random.default_rng(seed)
    leader = LinearTarget((0.0, 0.0), (1.5, -1.0)) if moving else StaticTarget((0.0, 0.0))
    match = 2.0 * zeta * np.sqrt(pull)
    law = Algorithm2(AlphaInteraction(), Gains(1.0, 1.0, 0.0, 0.0, (pull, 0.0), (match, 0.0)), leader)
    q = np.array([[2.0, 1.0], [500.0, -400.0]]) + rng.uniform(-1.0, 1.0, (2, 2))
    p = leader.rate(0.0) + np.array([[0.5, -0.5], [1.0, -1.0]]) * rng.uniform(0.5, 1.0, (2, 2))
    until = min(20.0 / truth.decay_rate(pull, match), 60.0)
    expected = dict.fromkeys(COLLISIONS, TRUE)
    expected |= {"energy": VERIFIED, "distance": VERIFIED, "informed": TRUE, "linked": VACUOUS}
    hold("su-informed", Case(law, q, p, until), expected)


def test_without_damping_an_informed_agent_swings_for_ever():
    """c2 > 0 is a hypothesis; with hardly any damping the limit is proved, far from it as the run ends."""
    gains = Gains(1.0, 1.0, 0.0, 0.0, (1.0, 0.0), (0.0, 0.0))
    q, p = np.array([[2.0, 1.0], [50.0, -40.0]]), np.array([[0.5, -0.5], [1.0, -1.0]])
    here = StaticTarget((0.0, 0.0))
    none = dict.fromkeys(("energy", "distance", "informed", "linked", *COLLISIONS), VACUOUS)
    hold("su-informed", Case(Algorithm2(AlphaInteraction(), gains, here), q, p, 9.0), none)
    slight = Gains(1.0, 1.0, 0.0, 0.0, (1.0, 0.0), (1e-3, 0.0))
    expected = none | dict.fromkeys(COLLISIONS, TRUE) | {"energy": TRUE, "distance": TRUE, "informed": VERIFIED}
    hold("su-informed", Case(Algorithm2(AlphaInteraction(), slight, here), q, p, 9.0), expected)


@effort(0.2)
@given(*[st.sampled_from(some) for some in ((0.3, 1.0, 3.0), (0.3, 1.0, 2.0), (0.02, 0.3))], st.booleans(), seeds)
def test_a_centre_that_is_told_converges(pull, zeta, frequency, feedforward, seed):
    rng = np.random.default_rng(seed)
    match = 2.0 * zeta * np.sqrt(pull)
    gains, circle = Gains(1.0, 1.0, 0.0, 0.0, pull, match), CircleTarget((0.0, 0.0), 4.0, frequency)
    law = Composition(AlphaInteraction(), gains, target=circle, feedforward=feedforward)
    q = np.array([[20.0, 0.0], [-20.0, 3.0]]) + rng.uniform(-1.0, 1.0, (2, 2))
    p = rng.uniform(-1.0, 1.0, (2, 2))
    expected = dict.fromkeys(("centre", "velocities", "distance", "no-collision"), VACUOUS)
    if feedforward:
        expected = {"centre": VERIFIED, "distance": VERIFIED, "velocities": TRUE, "no-collision": TRUE}
    hold("su-varying", Case(law, q, p, 6.0), expected)
