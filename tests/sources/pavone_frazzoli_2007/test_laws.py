"""Cyclic pursuit: its velocities, poles and circles against formulas of their own."""

from cmath import exp
from math import cos, pi, radians, sin

import numpy as np
import pytest

import flockana as fl
from tests.refused import refused

LAW = fl.CyclicPursuit(1.7, -25.0)
Q = np.random.default_rng(2).normal(size=(5, 2))


def test_velocities_are_those_written_out_agent_by_agent():
    turn = np.array([[cos(radians(-25.0)), -sin(radians(-25.0))], [sin(radians(-25.0)), cos(radians(-25.0))]])
    own = [1.7 * turn @ (Q[(i + 1) % 5] - Q[i]) for i in range(5)]
    np.testing.assert_allclose(LAW.velocity(0.0, Q), own, rtol=0.0, atol=1e-15)


@pytest.mark.parametrize(("n", "angle"), [(2, 90.0), (3, 60.0), (5, -25.0), (6, 100.0)])
def test_the_poles_are_those_of_the_matrix(n, angle):
    law = fl.CyclicPursuit(1.7, angle)
    own = [1.7 * exp(1j * radians(angle)) * (exp(2j * pi * j / n) - 1.0) for j in range(n)]
    np.testing.assert_allclose(law.eigenvalues(n), own, atol=1e-14)
    about = fl.linearise(law, np.ones((n, 2)))
    every = np.concatenate([own, np.conj(own)])
    for found in (about.eigenvalues, np.linalg.eigvals(law.jacobian(0.0, np.ones((n, 2))))):
        assert np.abs(found[:, None] - every[None]).min(axis=0).max() < 1e-12
    assert about.decay_rate == pytest.approx(-max(own[1:], key=lambda x: x.real).real, abs=1e-12)


def test_at_the_critical_angle_agents_circle_evenly_spaced():
    """Angular speed 2k sin(π/3) = √3 k; the radius is the part of the start in that mode."""
    law, q = fl.CyclicPursuit(2.0, 60.0), Q[:3]
    run = fl.simulate(law, q, None, (0.0, 12.0), rtol=1e-10)
    z = (q @ [1.0, 1j]) - (q @ [1.0, 1j]).mean()
    radius = abs(sum(z[k] * exp(-2j * pi * 2 * k / 3) for k in range(3))) / 3.0
    away = run.q[-1] - q.mean(axis=0)
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), radius, rtol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(run.p[-1], axis=1), radius * 2.0 * 3.0**0.5, rtol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(np.roll(away, 1, axis=0) - away, axis=1), radius * 3.0**0.5, rtol=1e-7)


test_what_is_refused = refused(
    (lambda: fl.CyclicPursuit(0.0), "gain = 0"),
    (lambda: fl.CyclicPursuit(angle=181.0), "angle = 181: expected degrees from -180 to 180"),
    (lambda: fl.simulate(LAW, [[0.0], [1.0]], None, (0.0, 1.0)), "m = 1"),
    (lambda: fl.simulate(LAW, [[0.0, 0.0]], None, (0.0, 1.0)), "n = 1: expected at least two agents"),
)
