"""The MSN project's map against a transcription in plain loops, and what its two peculiarities do."""

from math import cos, pi, sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, simulate
from flockana.environment.targets import CircleTarget, RescaledVelocity, StaticTarget
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.notebook_r2.laws import PushedAlgorithm1
from tests.refused import refused

D, R, EPS, H, A, B = 3.0, 3.6, 0.1, 0.1, 3.0, 4.0
C1A, C2A, C1G, C2G = 7.0, 2.5, 1.3, 0.9
ALPHA = AlphaInteraction(d=D, r=R, eps=EPS, h=H, a=A, b=B)
GAINS = Gains(c1_alpha=C1A, c2_alpha=C2A, c1_gamma=C1G, c2_gamma=C2G)
DT = 0.05
PULL = Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=0.0), target=StaticTarget((11.0,)))


def _norm(z: float) -> float:
    return (sqrt(1 + EPS * z * z) - 1) / EPS


def _bump(z: float) -> float:
    if z < H:
        return 1.0
    return 0.5 * (1 + cos(pi * (z - H) / (1 - H))) if z <= 1 else 0.0


def transcription(q, p, target, steps, t0=0.0):
    """The project's loops, agent by agent, from its description: net first, γ-agent next, then each agent in turn."""
    q, p = [list(x) for x in q], [list(x) for x in p]
    n, c = len(q), abs(A - B) / sqrt(4 * A * B)
    for step in range(1, steps + 1):
        net = [
            [sqrt(sum((a - b) ** 2 for a, b in zip(q[i], q[j], strict=True))) <= R for j in range(n)] for i in range(n)
        ]
        q_r, p_r = target.state(t0 + step * DT)
        for i in range(n):
            u = [-C1G * (q[i][k] - q_r[k]) - C2G * (p[i][k] - p_r[k]) for k in range(2)]
            for j in range(n):
                if not net[i][j] or i == j:
                    continue
                length = sqrt(sum((a - b) ** 2 for a, b in zip(q[i], q[j], strict=True)))
                z = _norm(length)
                s = z - _norm(D) + c
                phi = _bump(z / _norm(R)) * 0.5 * ((A + B) * s / sqrt(1 + s * s) + (A - B))
                for k in range(2):
                    u[k] += C1A * phi * (q[j][k] - q[i][k]) / sqrt(1 + EPS * length**2)
                    u[k] += C2A * _bump(z / _norm(R)) * (p[j][k] - p[i][k])
            for k in range(2):
                v = p[i][k] + u[k] * DT
                q[i][k] += v * DT + 0.5 * DT**2 * u[k]
                p[i][k] = v
    return np.array(q), np.array(p)


def flock(n=30, seed=3):
    generator = np.random.default_rng(seed)
    return generator.uniform(0.0, 12.0, (n, 2)), generator.standard_normal((n, 2))


@pytest.mark.parametrize("steps", [1, 5])
def test_as_printed_it_is_the_projects_loop(steps):
    target = RescaledVelocity(CircleTarget((5.0, 5.0), 3.0, 0.4), 0.3)
    law = MSNDiscretisation(Algorithm2(ALPHA, GAINS, target), DT)
    q, p = flock()
    run = simulate(law, q, p, (0.0, steps * DT))
    expected_q, expected_p = transcription(q, p, target, steps)
    # rounding only: the two sum in different orders, and errors grow by about the stiffness per step
    np.testing.assert_allclose(run.q[-1], expected_q, rtol=0, atol=1e-11)
    np.testing.assert_allclose(run.p[-1], expected_p, rtol=0, atol=1e-10)


def test_agents_linked_at_the_start_of_the_iteration_stay_neighbours_within_it():
    """Agent 1 starts out of reach of agent 0 and comes into reach when agent 0 moves first: no force in that step."""
    q, p = np.array([[0.0, 0.0], [R + 0.01, 0.0]]), np.array([[10.0, 0.0], [0.0, 0.0]])
    _, after, u, _ = MSNDiscretisation(Algorithm1(ALPHA, GAINS), DT).step(0.0, q, p, {})
    assert np.array_equal(u, np.zeros((2, 2)))
    assert np.array_equal(after, p)


def test_printed_step_exceeds_by_u_dt_squared_exactly():
    q, p, dt = np.array([[3.0]]), np.array([[-2.0]]), 0.125
    printed, right = (MSNDiscretisation(PULL, dt, position_factor=f).step(0.0, q, p, {}) for f in (1.5, 0.5))
    assert printed[2][0, 0] == right[2][0, 0] == 8.0
    assert printed[0][0, 0] - right[0][0, 0] == 8.0 * dt**2
    assert right[0][0, 0] == 3.0 - 2.0 * dt + 0.5 * 8.0 * dt**2


def test_in_place_breaks_action_and_reaction_and_all_at_once_keeps_it():
    q, p = flock()
    before = p.sum(axis=0)
    in_place, at_once = (
        MSNDiscretisation(Algorithm1(ALPHA, GAINS), DT, in_place=flag).step(0.0, q, p, {})[1].sum(axis=0) - before
        for flag in (True, False)
    )
    assert np.abs(at_once).max() < 1e-12
    assert np.abs(in_place).max() > 1e-2


def test_the_gamma_agent_has_already_moved():
    law = MSNDiscretisation(
        Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=0.0), target=CircleTarget((0, 0), 1.0, 0.25)), 1.0
    )
    for in_place in (True, False):
        u = MSNDiscretisation(law.law, 1.0, in_place=in_place).step(0.0, np.zeros((1, 2)), np.zeros((1, 2)), {})[2]
        np.testing.assert_allclose(u, [[0.0, 1.0]], atol=1e-15)


test_bad_arguments_are_named = refused(
    (lambda: MSNDiscretisation(PushedAlgorithm1(), DT), r"expected Algorithm1\(...\) or Algorithm2\(...\) itself"),
    (lambda: MSNDiscretisation(Algorithm1(), 0.0), "dt = 0: expected a number > 0"),
    (lambda: MSNDiscretisation(Algorithm1(), DT, in_place=1), "in_place = 1: expected True or False"),
    (
        lambda: simulate(MSNDiscretisation(PULL, DT), np.zeros((1, 2)), np.zeros((1, 2)), (0.0, 1.0)),
        "the target has 1 components",
    ),
)
