import numpy as np

from flockana.stability.axis_crossings import least_crossing, modal_crossing


def test_a_delayed_damping_alone_crosses_at_a_quarter_turn():
    one, zero = np.ones((1, 1)), np.zeros((1, 1))
    found = modal_crossing((zero, zero, zero, one), 0.0)  # x'' = −x'(t − τ)
    assert (found.delay, found.frequency, found.least) == (np.pi / 2, 1.0, np.pi / 2)


def test_the_least_crossing_is_bracketed_closely_without_common_modes():
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    prompt, late = np.diag([3.0, 1.0]), turn @ np.diag([2.0, 0.5]) @ turn.T
    found = least_crossing((prompt, np.eye(2), late, np.zeros((2, 2))), 0.0, 4.0)
    assert 0.0 < found.least <= found.delay <= 1.00001 * found.least
