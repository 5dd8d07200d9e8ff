"""Chaotic maps: the order and the side of the agents, by which sums round otherwise, decide no verdict."""

import numpy as np
import pytest

from flockana import Algorithm2, Gains, SemiImplicitEuler, StaticTarget, Tolerances, verify

LAW = SemiImplicitEuler(
    Algorithm2(gains=Gains(c1_alpha=30.0, c2_alpha=0.0, c1_gamma=1.1, c2_gamma=0.0), target=StaticTarget((0.0,))),
    0.0625,
)
Q = np.array([-4.3125, -4.140625, 2.96875, 3.921875])[:, None]
P = np.array([0.140625, 9.28125, 3.265625, -3.03125])[:, None]


@pytest.mark.parametrize(("order", "side"), [([0, 1, 2, 3], 1.0), ([3, 2, 1, 0], 1.0), ([1, 3, 0, 2], -1.0)])
def test_the_exact_orbit_decides_in_every_order_and_mirror(order, side):
    """After 584 steps it is at −17.00, −2.47, 10.33, 12.99 (mpmath, 120 digits): three parts at r = 8.4."""
    span, late = (0.0, 584 * 0.0625), Tolerances(settle=582.5 / 584)
    verdict = verify(
        "alpha-flocking-strict", law=LAW, q0=side * Q[order], p0=side * P[order], t_span=span, tolerances=late
    )
    claim = verdict.claim("flock")
    assert (claim.status, claim.computed, claim.rigour) == ("refuted", 3, "interval")
    assert verdict.known_until == 584
