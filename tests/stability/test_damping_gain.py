"""The gain at which a mode has a damping ratio, against closed forms and a search of the spectrum."""

from math import sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, find_equilibrium, linearise
from flockana.base.errors import ArgumentError, SolverError
from flockana.lattice import hexagonal_spiral
from flockana.stability.damping_gain import gain_for_damping
from tests.refused import refused

PAIR = [[0.0, 0.0], [7.0, 0.0]]
HEXAGON = hexagonal_spiral(7, 7.0)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.95])
def test_a_bond_is_damped_by_twice_the_consensus_gain(ratio):
    """A stretched bond has s² + 2 c2α a s + 2 k: with ζ at c2α = ζ √(2 k)/a, k and a read off K and D."""
    law = Algorithm1()
    linear = linearise(law, PAIR)
    k, a = linear.stiffness.toarray()[0, 0], linear.damping.toarray()[0, 0] / law.gains.c2_alpha
    damped = gain_for_damping(law, PAIR, "c2_alpha", ratio)
    assert damped.gain == pytest.approx(ratio * sqrt(2.0 * k) / a, rel=1e-8)
    assert damped.mode.damping_ratio == pytest.approx(ratio, rel=1e-8)
    assert damped.law.gains.c2_alpha == damped.gain


@pytest.mark.slow
def test_the_centre_and_any_mode_by_its_name():
    law = Algorithm2(target=StaticTarget((0.0, 0.0)), gains=Gains(c1_gamma=9.0, c2_gamma=0.5))
    centre = gain_for_damping(law, HEXAGON, "c2_gamma", 0.7, mode="translation x")
    assert centre.gain == pytest.approx(2.0 * 0.7 * 3.0, rel=1e-8)
    stiffer = gain_for_damping(law, HEXAGON, "c1_gamma", 0.05, mode="translation y")
    assert stiffer.gain == pytest.approx((0.5 / 0.1) ** 2, rel=1e-8)


def test_the_slowest_swing_of_a_squeezed_flock_has_the_ratio_at_its_own_equilibrium():
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    damped = gain_for_damping(law, HEXAGON, "c2_alpha", 0.4)
    modes = linearise(damped.law, find_equilibrium(damped.law, HEXAGON)).modes
    assert min(abs(mode.damping_ratio - 0.4) for mode in modes) < 1e-8
    assert damped.gain != law.gains.c2_alpha


test_what_is_refused = refused(
    (lambda law: gain_for_damping(law, PAIR, "c2_alpha", 1.0), "ratio = 1: expected a damping ratio"),
    (lambda law: gain_for_damping(law, PAIR, "speed", 0.5), "unknown gain 'speed'"),
    (lambda law: gain_for_damping("law", PAIR, "c2_alpha", 0.5), "expected a law with gains"),
    (lambda law: gain_for_damping(law, PAIR, "c2_alpha", 0.5, mode="9"), "unknown mode '9'"),
    (
        lambda law: gain_for_damping(law, PAIR, "c2_alpha", 0.5, between=(30.0, 90.0)),
        "expected to hold the law's own c2_alpha",
    ),
    (
        lambda law: gain_for_damping(law, PAIR, "c2_alpha", 0.9, between=(1.0, 12.0), steps=5),
        "has ζ = .* at c2_alpha = 1 to 12: expected 0.9 among them",
        SolverError,
    ),
    make=lambda call: call(Algorithm1()),
)


def test_a_gain_of_each_agent_is_refused():
    law = Algorithm2(target=StaticTarget((0.0, 0.0)), gains=Gains(c2_gamma=np.array([1.0, 2.0])))
    with pytest.raises(ArgumentError, match="c2_gamma"):
        gain_for_damping(law, PAIR, "c2_gamma", 0.5)
