"""The basin of two agents at their contact, against the force between them and its slope."""

from math import inf, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from flockana import DeadZoneFlocking, DeadZoneInteraction
from flockana.sources.li_dead_zone.theorems.local_basin import hold

LAW = DeadZoneFlocking()
CONTACT = 3.49973  # within 1e-5 of where repulsion and the pull k₁ balance, on the inner ramp


def slope(s, h=1e-6):
    force = LAW.interaction.force
    return float(force(np.array([s - h]))[0] - force(np.array([s + h]))[0]) / (2.0 * h)


@pytest.mark.parametrize(("m", "speed"), [(1, 0.0), (1, 1e-4), (2, 1e-4)])
def test_the_well_is_that_of_one_spring(m, speed):
    """Off the rigid motions the Hessian of U(s) has the one eigenvalue 2F', and |∇U| is √2 |F|; K is that of both."""
    q, p = np.zeros((2, m)), np.zeros((2, m))
    q[1, 0], p[0, 0], p[1, 0] = CONTACT, speed, -speed
    basin = hold(LAW, q, p)
    force = float(LAW.interaction.force(np.array([CONTACT]))[0])
    stiff = 2.0 * slope(CONTACT)
    assert basin.curvature == pytest.approx(stiff, rel=1e-6)
    assert basin.distance == pytest.approx(2.0 * sqrt(2.0) * abs(force) / stiff, rel=1e-5)
    assert basin.excess == pytest.approx(speed**2 + 2.0 * force**2 / stiff, rel=1e-5)
    assert basin.stability == 1.0
    # no window passes the end of the ramp, 0.999 of the way; the well is that of the spring, and its barrier less
    kink = min(abs(CONTACT - k) for k in (LAW.interaction.d1 - LAW.interaction.ramp, LAW.interaction.d1))
    assert 0.0 < basin.barrier < 0.5 * stiff * (0.999 * kink / sqrt(2.0)) ** 2


@pytest.mark.slow
@pytest.mark.parametrize("dt", [0.001, 0.01])
def test_a_step_is_stable_below_the_inverse_of_stiffness_and_damping(dt):
    """Λ = 2F' of the spring, Γ = 2 k₂ of the pair."""
    q = np.array([[0.0], [CONTACT]])
    expected = 1.0 - 0.5 * (dt**2 * 2.0 * slope(CONTACT) + 2.0 * dt * 2.0 * LAW.k2)
    assert hold(LAW, q, 0.0 * q, dt).stability == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(
    ("law", "s"),
    [
        (LAW, 3.4),  # in the middle of the repulsion: no minimum beside it
        (LAW, 5.0),  # in the dead zone, where k₁ alone pulls
        (DeadZoneFlocking(k2=0.0), CONTACT),  # nothing damps
        (DeadZoneFlocking(DeadZoneInteraction(ramp=0.0)), 3.5),  # on the jump itself
    ],
)
def test_elsewhere_nothing_is_known(law, s):
    basin = hold(law, np.array([[0.0], [s]]), np.zeros((2, 1)))
    assert not basin.certificate.margin > 0.0


def test_one_agent_is_held_by_nothing_and_goes_nowhere():
    basin = hold(LAW, np.zeros((1, 2)), np.ones((1, 2)))
    assert (basin.excess, basin.barrier, basin.reach) == (0.0, inf, 0.0)


@pytest.mark.parametrize("n", [2, 3])
def test_at_the_contact_itself_the_force_is_what_its_sums_round(n):
    """Of each coordinate (n + 16) ε times Λ r, Λ the stiffness: 2F' of a pair, 3F' of a triangle; the force is 0."""
    s = brentq(lambda s: float(LAW.interaction.force(np.array([s]))[0]), 3.499, 3.49999, xtol=1e-15, rtol=1e-15)
    q = s * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, sqrt(0.75)]])[:n, : n - 1]
    basin = hold(LAW, q, np.zeros_like(q))
    stiff = n * slope(s)
    rounding = sqrt(q.size) * (n + 16.0) * np.finfo(float).eps * stiff * LAW.interaction.r
    assert 0.5 * basin.distance * basin.curvature == pytest.approx(rounding, rel=0.05, abs=0.0)
    assert basin.excess == pytest.approx(rounding**2 / basin.curvature, rel=0.1, abs=0.0)
