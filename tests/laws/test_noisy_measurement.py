"""Measured laws: what noise on sensors does to one agent in the mean, and who sees it."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, CuckerSmale, Gains, Measured, Sampled, StaticTarget, simulate
from tests.refused import refused

ALONE = Gains(c1_alpha=0.0, c2_alpha=0.0, c1_gamma=4.0, c2_gamma=2.0)
LAW = Algorithm2(gains=ALONE, target=StaticTarget((0.0, 0.0)))


@pytest.mark.slow
@pytest.mark.parametrize("dt", [0.02, 0.005])
def test_noise_on_position_acts_as_a_force_that_many_times_as_strong(dt):
    """x'' = −k (x + σ ξ) − d x': variance (kσ)²/2dk of the place, whatever the step."""
    sigma, q = 0.1, np.zeros((64, 2))
    run = simulate(Measured(LAW, position=sigma), q, q, (0.0, 40.0), dt=dt, t_eval=np.arange(10.0, 40.0, 1.0))
    assert run.q.var() == pytest.approx((4.0 * sigma) ** 2 / (2.0 * 2.0 * 4.0), rel=0.1)


def test_sampled_readings_are_less_noisy_the_longer_the_period():
    law = Sampled(Measured(LAW, velocity=0.3), 0.05)
    q = np.zeros((400, 2))
    run = simulate(law, q, q, (0.0, 0.05), dt=0.05)
    assert run.u[-1].std() == pytest.approx(2.0 * 0.3 / 0.05**0.5, rel=0.1)


def test_noise_on_what_is_heard_leaves_a_lone_agent_in_peace():
    pair = [[0.0], [7.0]]
    law = Algorithm1()
    heard = simulate(Measured(law, position=0.01, of="neighbours"), pair, [[0.0], [0.0]], (0.0, 0.1), dt=0.01)
    assert np.abs(heard.u[1:]).min() > 0.0
    assert np.abs(heard.u[1:].sum(axis=1)).max() > 1e-3  # each hears noise of its own
    alone = simulate(Measured(law, position=0.01, of="neighbours"), [[0.0]], [[1.0]], (0.0, 0.1), dt=0.01)
    assert np.abs(alone.u).max() == 0.0


test_bad_input = refused(
    (lambda: Measured(LAW, velocity=float("nan")), "velocity = nan"),
    (lambda: Measured(LAW, of="some"), "of = 'some'"),
    (lambda: Measured(CuckerSmale(), 1.0, of="neighbours"), "expected a sum of terms with a pair term"),
)
