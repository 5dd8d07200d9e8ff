"""Agents that follow copies: Algorithm 2 where these are alike, the energy's balance, and how flocks part with them."""

import numpy as np
import pytest

from flockana import Algorithm2, Copies, Gains, LinearTarget, PeerToPeer, Spring, simulate
from flockana.lattice import hexagonal_spiral
from tests.refused import refused

FREE, RNG = Spring((0.0, 0.0), 0.0), np.random.default_rng(4)
Q, P = hexagonal_spiral(6, 7.0) + RNG.uniform(-0.5, 0.5, (6, 2)), RNG.uniform(-1.0, 1.0, (6, 2))
DIFFERENT = Copies(Q + RNG.normal(0.0, 2.0, (6, 2)), RNG.normal(0.0, 1.0, (6, 2)), Spring((3.0, 1.0), 0.2, 0.1))


@pytest.mark.parametrize("gains", [Gains(), Gains(c1_gamma=np.linspace(0.5, 2.0, 6), c2_gamma=1.0)])
def test_copies_that_are_alike_make_it_algorithm_2(gains):
    alike = Copies(np.tile([20.0, 5.0], (6, 1)), np.tile([3.0, -1.0], (6, 1)), FREE)
    one, leader = PeerToPeer(alike, gains=gains), Algorithm2(gains=gains, target=LinearTarget((20.0, 5.0), (3.0, -1.0)))
    for t in (0.0, 9.0):
        u = leader.acceleration(t, Q, P)
        np.testing.assert_allclose(one.acceleration(t, Q, P), u, atol=1e-11 * np.abs(u).max())
    ends = [simulate(law, Q, P, (0.0, 5.0), t_eval=[5.0], rtol=1e-10).q[-1] for law in (one, leader)]
    np.testing.assert_allclose(*ends, atol=1e-7)


def test_the_balance_of_energy_is_kept_while_copies_drift():
    whole = simulate(PeerToPeer(DIFFERENT), Q, P, (0.0, 20.0))
    assert np.abs(whole.energy_residual).max() < 1e-7 * np.abs(whole.energy()).max()


test_copies_must_be_as_many_as_agents = refused(
    (lambda: simulate(PeerToPeer(DIFFERENT), Q[:5], P[:5], (0.0, 1.0)), "there are 6 copies and 5"),
    (
        lambda: PeerToPeer(DIFFERENT).acceleration(0.0, np.zeros((6, 3)), np.zeros((6, 3))),
        "the copies have 2 components",
    ),
    (lambda: PeerToPeer(3), "copies = 3: expected Copies"),
    (lambda: PeerToPeer(DIFFERENT, gains=Gains(c1_gamma=(1.0, 2.0))).acceleration(0.0, Q, P), "c1_gamma has 2 gains"),
)
