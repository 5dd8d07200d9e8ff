"""E12 against the transfer function in closed form; the linearisation where a run ends."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains
from flockana.environment.targets import CircleTarget, RescaledVelocity, SineTarget, StaticTarget
from tests.adversarial import truth
from tests.adversarial.cases import FALSE, OPEN, REFUTED, TRUE, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import seeds

THEOREMS = ("E12", "linearised-decay-terminal")


@effort(0.4)
@given(
    st.sampled_from((0.3, 1.0, 1.3, 1.5, 3.0, 10.0)),  # ω/√c1γ: the gain with the true p_r is 1 at √2
    st.sampled_from((0.05, 0.5, 1.0, 3.0)),  # ζ
    st.sampled_from((0.0, 0.009, 0.5, -1.0, 2.0)),
    st.sampled_from((1.0, 1.1, 2.5, 8.0)),
    st.booleans(),
    seeds,
)
def test_the_centre_of_mass_is_a_filter(ratio, zeta, factor, periods, circle, seed):
    rng = np.random.default_rng(seed)
    omega = ratio
    gains = Gains(1.0, 0.1, 0.0, 0.0, 1.0, 2.0 * zeta)
    f = omega / (2.0 * np.pi)
    here = (0.0, 0.0)
    path = CircleTarget(here, 5.0, f, rng.uniform(0.0, 6.0)) if circle else SineTarget(here, (1.0, 0.0), 5.0, f)
    settle = 30.0 / truth.decay_rate(1.0, 2.0 * zeta)
    long = periods == 8.0
    until = periods / f + (settle if long else 0.0)
    assume(until < 700.0)
    law = Algorithm2(AlphaInteraction(), gains, RescaledVelocity(path, factor))
    q, p = 20.0 * rng.normal(size=(1, 2)), 3.0 * rng.normal(size=(1, 2))
    own = truth.filter_gain(1.0, 2.0 * zeta, omega)
    clear = long and abs(own - 1.0) > 0.05
    printed = (VERIFIED if clear else TRUE) if own < 1.0 else (REFUTED if clear else FALSE)
    agree = VERIFIED if long else TRUE
    hold("E12", Case(law, q, p, until), {"predicted": agree, "consistent": agree, "printed": printed})


@pytest.mark.parametrize("m", [1, 2])
@pytest.mark.parametrize("pull", [0.0, 0.02])
def test_a_pair_near_its_balance_moves_as_linearised(m, pull):
    law = Algorithm2(AlphaInteraction(), Gains(1.0, 0.5, 0.0, 0.0, pull or 1e-4, 1.0), StaticTarget((0.0,) * m))
    s = truth.balanced_length(law)
    q = np.outer([-0.5 * s, 0.5 * s], np.eye(m)[0])
    hold("linearised-decay-terminal", Case(law, q * 1.01, 0.0 * q, 30.0), {"decay": VERIFIED, "random": TRUE})


@pytest.mark.parametrize("gains", [Gains(1.0, 0.0, 0.0, 0.0, 0.0, 0.0), Gains(0.0, 0.0, 0.0, 0.0, 1.0, 0.0)])
def test_without_damping_nothing_decays(gains):
    q = np.array([[0.0, 0.0], [7.05, 0.0]])
    for law in (Algorithm1(gains=gains), Algorithm2(gains=gains, target=StaticTarget((3.5, 0.0)))):
        hold("linearised-decay-terminal", Case(law, q, 0.0 * q, 3.0), {"decay": OPEN, "random": OPEN})
