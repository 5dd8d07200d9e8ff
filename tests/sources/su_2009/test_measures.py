"""Who moves as the leader does at the end of a run."""

import numpy as np

from flockana import Algorithm2, CircleTarget, Trajectory
from flockana.measures.measure import measures
from flockana.sources.su_2009.measures import following


def test_only_who_moves_as_the_leader_at_the_end_follows_it():
    """The leader goes round: one agent moves as it does at the end, one as at the second sample, two about as fast."""
    leader, t = CircleTarget((0.0, 0.0), 5.0, 0.8), np.array([0.0, 0.5, 2.0])  # 1.6 turns: it ends as at no sample
    law = Algorithm2(target=leader)
    rate, slack = leader.rate(2.0), 0.01 * law.scales.speed
    about = np.add(rate, (0.99 * slack, 0.0)), np.add(rate, (0.0, 1.01 * slack))
    p = np.tile([rate, leader.rate(0.5), *about], (3, 1, 1))
    p[:2] = 0.0  # what was before the end is not asked for
    run = Trajectory(t, np.arange(24.0).reshape(3, 4, 2), p, np.zeros((3, 4, 2)), law)
    assert following(run).tolist() == [True, False, True, False]
    assert measures()["followers"].number(run) == 0.5
