"""Who is within reach of a ball, found without a branch."""

import numpy as np
import pytest

from flockana.kernels.obstacle_crossings import out_of_reach, within_reach


@pytest.mark.parametrize("m", [1, 2, 3])
def test_those_within_reach_are_named_in_rising_order_the_boundary_and_the_lost_among_them(m):
    rng = np.random.default_rng(m)
    balls = np.array([np.zeros(m + 1), [*rng.uniform(-1.0, 1.0, m), 0.5]])
    q = rng.uniform(-3.0, 3.0, (40, m))
    q[7], q[11] = balls[1, :m], np.nan
    near, s2 = np.empty(40, np.int64), np.empty(40)
    for reach in (0.0, 1.0, 2.5, np.inf):
        count = within_reach(q, balls, 1, reach, s2, near)
        distance = np.linalg.norm(q - balls[1, :m], axis=1)
        assert near[:count].tolist() == np.flatnonzero(~(distance > 0.5 + reach)).tolist()
        assert near[:count].tolist() == [i for i in range(40) if not out_of_reach(q, i, balls, 1, reach)]
    on_the_boundary = np.zeros((1, m))
    on_the_boundary[0, 0] = 2.0
    assert within_reach(on_the_boundary, np.array([[*np.zeros(m), 0.5]]), 0, 1.5, s2, near) == 1
    assert within_reach(on_the_boundary, np.array([[*np.zeros(m), 0.5]]), 0, 1.5 - 1e-15, s2, near) == 0
