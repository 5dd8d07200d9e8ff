import numpy as np

from flockana.environment.targets import CircleTarget
from flockana.laws.terms.feedforward import TargetFeedforward


def test_agents_are_told_the_acceleration_of_the_target():
    circle, u = CircleTarget((0.0, 0.0), radius=2.0, frequency=0.5 / np.pi), np.zeros((1, 2))
    assert (TargetFeedforward(circle, True).act(0.0, 0.0 * u, 0.0 * u, u), u.tolist()) == (0.0, [[-2.0, 0.0]])
