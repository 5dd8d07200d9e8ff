"""Sampled laws: the Taylor step, holds longer than a step, clocks of their own, bad input."""

import numpy as np
import pytest

from flockana import Algorithm2, Gains, Sampled, StaticTarget, TaylorStep, simulate
from flockana.lattice import hexagonal_patch
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
Q = hexagonal_patch(1, 7.0) + 0.3


@pytest.mark.parametrize("steps", [1, 4])
@pytest.mark.parametrize("method", ["Euler-Maruyama", "RK4"])
def test_a_hold_is_the_taylor_step(steps, method):
    held = simulate(Sampled(LAW, 0.02), Q, 0.0 * Q, (0.0, 1.0), dt=0.02 / steps, method=method)
    steps_by_hand = simulate(TaylorStep(LAW, 0.02), Q, 0.0 * Q, (0.0, 1.0))
    np.testing.assert_allclose(held.q[::steps], steps_by_hand.q, rtol=0.0, atol=1e-11)


def test_each_agent_samples_by_its_own_clock():
    """Two agents that do not see each other: the second begins half a period late, and moves freely until then."""
    one = Algorithm2(gains=Gains(c1_alpha=0.0, c1_gamma=1.0, c2_gamma=0.0), target=StaticTarget((0.0,)))
    run = simulate(Sampled(one, 0.2, offsets=(0.0, 0.1)), [[1.0], [101.0]], [[0.0], [1.0]], (0.0, 0.4), dt=0.1)
    assert run.p[:, 0, 0] == pytest.approx([0.0, -0.1, -0.2, -0.2 - 0.1 * 0.98, -0.2 - 0.2 * 0.98])
    late = 101.1
    assert run.p[:3, 1, 0] == pytest.approx([1.0, 1.0, 1.0 - 0.1 * late])


test_bad_input = refused(
    (lambda: Sampled(LAW, 0.1, offsets=(0.1,)), r"offsets = .*: expected one for each agent, 0 <= offset < 0.1"),
    (lambda: simulate(Sampled(LAW, 0.1, offsets=(0.0,)), Q, Q, (0, 1), dt=0.1), "there are 1 offsets and 7 agents"),
    (lambda: simulate(Sampled(LAW, 0.1), Q, Q, (0, 1), dt=0.2), "divides the delay or period 0.1, such as 0.1"),
)
