"""Motions of the errata: where they start, and steps in blocks of 500 as steps at once."""

import numpy as np
import pytest

from flockana.sources.li_dead_zone.theorems.shared_runs import advance, parting_pair


@pytest.mark.parametrize(("dt", "t_end", "steps"), [(0.01, 10.0, 1000), (0.01, 13.0, 1500), (0.004, 4.0, 1000)])
def test_the_last_of_many_steps(dt, t_end, steps):
    law, q, p = parting_pair()[0], np.array([[0.0, 0.0], [3.0, 0.5]]), np.array([[0.0, 0.0], [0.0, 1.0]])
    states = law.semi_implicit(q, p, dt, steps)
    found = advance(law, q, p, dt, t_end)
    np.testing.assert_array_equal(found[0], states[0][-1])
    np.testing.assert_array_equal(found[1], states[1][-1])
