"""Explicit Euler steps: both states with the old one, the order of the scheme, what it does to a swing."""

import numpy as np
import pytest

from flockana import Algorithm2, ExplicitEuler, Gains, StaticTarget, simulate


def swing(damping):
    return Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=damping), target=StaticTarget((0.0,)))


def test_a_step_uses_the_old_velocity():
    q, p, u, memory = ExplicitEuler(swing(1.0), 0.1).step(0.0, np.array([[1.0]]), np.array([[2.0]]), {})
    assert (q[0, 0], p[0, 0], u[0, 0], memory) == (1.2, pytest.approx(1.4), pytest.approx(-6.0), {})


def test_an_undamped_swing_grows_by_a_known_factor():
    """|1 + 2jh| = √(1 + 4h²) a step."""
    run = simulate(ExplicitEuler(swing(0.0), 0.01), [[1.0]], [[0.0]], (0.0, 10.0))
    size = np.hypot(run.q[:, 0, 0], run.p[:, 0, 0] / 2.0)
    assert size[-1] == pytest.approx((1.0 + 4e-4) ** 500, rel=1e-9)
