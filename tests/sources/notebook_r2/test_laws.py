"""The notebook's push: where it acts, how strongly, and what it does to the energy balance."""

from math import sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, StaticTarget
from flockana.sources.notebook_r2.laws import PushedAlgorithm1, PushedAlgorithm2, extra_push
from tests.refused import refused

ALPHA = AlphaInteraction(d=1.9, r=2.8, eps=0.1, h=0.4, a=7.0, b=9.0)
GAINS = Gains(c1_alpha=2.0, c2_alpha=1.5, c1_gamma=0.3, c2_gamma=0.7)
TARGET = StaticTarget((1.0, 2.0), (0.7, 0.1))
PAIRS = [
    (PushedAlgorithm1(ALPHA, GAINS), Algorithm1(ALPHA, GAINS)),
    (PushedAlgorithm2(ALPHA, GAINS, TARGET), Algorithm2(ALPHA, GAINS, TARGET)),
]


def crowd(seed=1):
    """Twelve agents, of which three pairs are closer than 0.05."""
    generator = np.random.default_rng(seed)
    q = generator.uniform(0.0, 3.0, (12, 2))
    q[1::4] = q[::4] + generator.uniform(-0.02, 0.02, (3, 2))
    return q, generator.standard_normal((12, 2))


@pytest.mark.parametrize("length", [0.01, 0.0499])
def test_below_the_distance_n_is_that_of_ten_times_the_difference(length):
    """Values by hand: φ_α(z) at the true distance times σ_ε(10 Δ), unit c1α."""
    law = PushedAlgorithm1(ALPHA, Gains(c1_alpha=1.0, c2_alpha=1.0))
    u = law.acceleration(0.0, [[0.0, 0.0], [length, 0.0]], np.zeros((2, 2)))
    z = (sqrt(1 + 0.1 * length**2) - 1) / 0.1
    s = z - (sqrt(1 + 0.1 * 1.9**2) - 1) / 0.1 + 2.0 / sqrt(4 * 63.0)
    phi = 0.5 * (16.0 * s / sqrt(1 + s * s) - 2.0)
    ten = 10 * length
    assert u[0, 0] == pytest.approx(phi * ten / sqrt(1 + 0.1 * ten**2), rel=1e-12)
    assert u[1, 0] == -u[0, 0]


@pytest.mark.parametrize(("pushed", "plain"), PAIRS)
def test_it_acts_only_below_the_distance(pushed, plain):
    p = np.array([[0.3, 0.0], [0.0, 0.2]])
    for length, same in ((0.0501, True), (0.05, True), (0.0499, False)):
        q = [[0.0, 0.0], [length, 0.0]]
        assert np.array_equal(pushed.acceleration(0.0, q, p), plain.acceleration(0.0, q, p)) is same
        assert (pushed.energy_rate(0.0, q, p) == plain.energy_rate(0.0, q, p)) is same


@pytest.mark.parametrize(("pushed", "plain"), PAIRS)
def test_energy_rate_is_the_derivative_of_the_energy_along_the_flow(pushed, plain):
    q, p = crowd()
    u, step = pushed.acceleration(0.0, q, p), 1e-6
    ahead, behind = (pushed.energy(0.0, q + s * p, p + s * u) for s in (step, -step))
    # central difference: error about step² |H'''| + rounding of H (about 1e2)/step, below 1e-7 of the rate
    assert pushed.energy_rate(0.0, q, p) == pytest.approx((ahead - behind) / (2 * step), rel=1e-6)
    assert abs(pushed.energy_rate(0.0, q, p) - plain.energy_rate(0.0, q, p)) > 0.1


def test_the_pushes_cancel_and_coincident_agents_feel_none():
    q, _ = crowd()
    f = extra_push(ALPHA, q, min_distance=0.05, factor=10.0)
    assert np.abs(f).max() > 0.1
    assert np.abs(f.sum(axis=0)).max() < 1e-13
    assert not extra_push(ALPHA, np.zeros((2, 2)), min_distance=0.05, factor=10.0).any()


test_bad_parameters_are_named = refused(
    (lambda: PushedAlgorithm1(factor=0.5), r"factor = 0\.5: expected at least 1"),
    (lambda: PushedAlgorithm2(target=TARGET, min_distance=0.0), "min_distance = 0: expected a number > 0"),
)
