"""Lossy laws: nothing, all or a share of the messages lost."""

import numpy as np
import pytest

from flockana import Algorithm1, Gains, Lossy, NetConsensus, Sampled, TaylorStep, simulate
from tests.refused import refused

LAW = Algorithm1(gains=Gains(c1_alpha=1.0, c2_alpha=0.5))
PAIR, STILL = np.array([[0.0], [8.0]]), np.zeros((2, 1))


def test_no_loss_is_the_law_and_all_lost_is_none():
    whole = simulate(TaylorStep(LAW, 0.01), PAIR, STILL, (0.0, 1.0))
    kept, lost = (simulate(Sampled(Lossy(LAW, loss), 0.01), PAIR, STILL, (0.0, 1.0), dt=0.01) for loss in (0.0, 1.0))
    np.testing.assert_allclose(kept.q, whole.q, rtol=0.0, atol=1e-12)
    np.testing.assert_array_equal(lost.q, np.broadcast_to(PAIR, lost.q.shape))


def test_messages_are_lost_by_their_probability_and_each_way_by_itself():
    run = simulate(Sampled(Lossy(LAW, 0.3, seed=4), 1e-4), PAIR, STILL, (0.0, 0.2), dt=1e-4)
    arrived = run.u[1:, :, 0] != 0.0
    assert arrived.mean() == pytest.approx(0.7, abs=0.03)
    assert (arrived[:, 0] != arrived[:, 1]).mean() == pytest.approx(2 * 0.7 * 0.3, abs=0.03)


def test_a_net_loses_its_links_one_by_one():
    """Velocity consensus, held for each step: u tells which of two links arrived."""
    net = NetConsensus([[0.0, 0.0, 0.0], [1.0, 0.0, 3.0], [2.0, 0.0, 0.0]], position=0.0, velocity=1.0)
    law = Sampled(Lossy(net, 0.4, seed=2), 1e-5)
    run = simulate(law, np.zeros((3, 1)), [[1.0], [0.0], [-1.0]], (0.0, 0.02), dt=1e-5)
    u = run.u[1:, :, 0]
    near, share = np.abs(u[:, 1, None] - [1.0, -3.0, -2.0, 0.0]) < 0.4, 0.6
    assert near.any(axis=1).all()
    assert near.mean(axis=0) == pytest.approx([share * 0.4, share * 0.4, share**2, 0.4**2], abs=0.04)
    assert (np.abs(u[:, 2] - 4.0) < 0.4).mean() == pytest.approx(share, abs=0.04)
    assert not u[:, 0].any()


test_bad_input = refused(
    (-0.1, "loss = -0.1"), (1.1, "loss = 1.1: expected a probability"), make=lambda loss: Lossy(LAW, loss)
)
