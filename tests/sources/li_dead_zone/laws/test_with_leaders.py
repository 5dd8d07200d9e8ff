"""The dead-zone law with leaders: against a transcription in plain loops, its energy, derivatives, what it refuses."""

from dataclasses import replace
from functools import partial
from math import cos, pi, sin

import numpy as np
import pytest

from flockana import CircleTarget, LedDeadZoneFlocking, LinearTarget, RescaledVelocity, StaticTarget, simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.terms.leaders import known_path
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.symbolic.energy_balances import led_energy_identity
from tests.refused import refused

LEADERS = CircleTarget((1.0, 2.0), 3.0, frequency=0.1, phase=0.4), LinearTarget((9.0, 0.0), (-0.5, 1.0))
GROUP, PINNED = (0, 1, 0, 1, 0, 1), (0, 1, 4)
LAW = LedDeadZoneFlocking(leaders=LEADERS, group=GROUP, pinned=PINNED, c1=0.7, c2=1.3, k2=0.9)


def a_state(seed=3, box=12.0):
    generator = np.random.default_rng(seed)
    return generator.uniform(0.0, box, (6, 2)), generator.uniform(-1.0, 1.0, (6, 2))


def transcribed(t, q, p, *, feedforward=True):
    """u_i by loops over agents; the circle's acceleration by hand."""
    angle, rate = 2.0 * pi * 0.1 * t + 0.4, 2.0 * pi * 0.1
    turn = np.array((cos(angle), sin(angle)))
    led = [
        (np.array((1.0, 2.0)) + 3.0 * turn, 3.0 * rate * np.array((-turn[1], turn[0])), -3.0 * rate**2 * turn),
        (np.array((9.0, 0.0)) + t * np.array((-0.5, 1.0)), np.array((-0.5, 1.0)), np.zeros(2)),
    ]
    u = np.zeros_like(q)
    for i in range(6):
        place, velocity, bend = led[GROUP[i]]
        for j in range(6):
            rho = float(np.linalg.norm(q[j] - q[i]))
            if j == i or rho >= 15.0:
                continue
            u[i] -= LAW.interaction.force(rho) * (q[j] - q[i]) / rho
            if GROUP[i] == GROUP[j]:
                u[i] += 0.9 * (p[j] - p[i])
        if i in PINNED:
            u[i] += 0.7 * (place - q[i]) + 1.3 * (velocity - p[i])
        if feedforward:
            u[i] += bend
    return u


@pytest.mark.parametrize("feedforward", [True, False])
@pytest.mark.parametrize("seed", [3, 4])
def test_the_input_is_that_of_its_formula(feedforward, seed):
    q, p = a_state(seed)
    law = replace(LAW, feedforward=feedforward)
    np.testing.assert_allclose(
        law.acceleration(0.7, q, p), transcribed(0.7, q, p, feedforward=feedforward), rtol=1e-11, atol=1e-11
    )


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("feedforward", [True, False])
def test_the_identity_of_the_energy_is_derived(m, feedforward):
    assert led_energy_identity(m, feedforward=feedforward).holds


def test_with_one_leader_the_energy_falls_by_the_dissipation_alone():
    law = replace(LAW, leaders=LEADERS[:1], group=(0,) * 6)
    q, p = a_state()
    slip = p - law.ties.led(0.3)[1]
    near = np.linalg.norm(q[:, None] - q[None], axis=2) < 15.0
    matched = sum(0.5 * near[i, j] * np.sum((p[i] - p[j]) ** 2) for i in range(6) for j in range(6))
    lost = 0.9 * matched + 1.3 * sum(np.sum(slip[i] ** 2) for i in PINNED)
    assert law.energy_rate(0.3, q, p) == pytest.approx(-lost, rel=1e-9)


def test_what_it_measures():
    q = np.array([[[0.0, 0.0], [4.0, 0.0]]])
    law = LedDeadZoneFlocking(leaders=(StaticTarget((0.0, 3.0)),), group=(0, 0))
    run = Trajectory(np.array([0.0]), q, np.array([[[0.0, 0.0], [0.0, 2.0]]]), 0.0 * q, law)
    assert (run.metric("leader_distance")[0], run.metric("leader_slip")[0]) == (5.0, 2.0)


test_what_it_refuses = refused(
    ({"interaction": DeadZoneInteraction(ramp=0.0)}, "ramp = 0: expected a ramp"),
    ({"interaction": 3.0}, "interaction = 3.0: expected DeadZoneInteraction"),
    ({"c1": -1.0}, "c1 = -1: expected a gain >= 0"),
    ({"leaders": ()}, r"leaders = \(\): expected one or more"),
    ({"leaders": LEADERS[0]}, "expected one or more"),
    ({"leaders": (RescaledVelocity(LEADERS[0], 0.5), LEADERS[1])}, "with its true"),
    ({"group": (0, 2, 0, 1, 0, 1)}, "group has 2: expected the number of a leader, 0 to 1"),
    ({"pinned": (6,)}, "pinned has 6: expected an agent, 0 to 5"),
    ({"leaders": 3}, "leaders = 3: expected one or more"),
    ({"group": (0, 0.5, 0, 1, 0, 1)}, "group has 0.5: expected the number of a leader"),
    ({"group": "010101"}, "group = '010101': expected a sequence of whole numbers"),
    ({"group": 3}, "group = 3: expected a sequence of whole numbers"),
    ({"pinned": (True,)}, "pinned has True: expected an agent"),
    make=partial(replace, LAW),
)


SIX = np.zeros((6, 2))
test_leaders_and_flocks_it_is_not_for = refused(
    (lambda: known_path(RescaledVelocity(LEADERS[0], 0.5)), "with its true velocity"),
    (lambda: known_path(StaticTarget((0.0, 0.0), (1.0, 0.0))), "with its true velocity"),
    (lambda: known_path(None), "with its true velocity"),
    (lambda: LAW.acceleration(0.0, SIX[:5], SIX[:5]), "group has 6 entries but there are 5 agents"),
    (lambda: LAW.acceleration(0.0, np.eye(6, 3), np.eye(6, 3)), "a leader has 2 components but the agents have 3"),
    (lambda: simulate(LAW, SIX, SIX, (0.0, 1.0)), "agents 0 and 1 coincide"),
)
