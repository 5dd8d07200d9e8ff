"""Erratum J3: the matrices of the path of four, by hand."""

import numpy as np

from flockana.theorems.bearing_distance.j03 import path_matrices


def test_the_path_of_four():
    stiffness, damping = path_matrices(1.0)
    # by hand: ends want 1 and have 2.05, the middle ones want 2; an edge's row is minus the difference of two agents
    end, own, middle = 1 - 1 / 2.05, 1 - 2 / 2.05, 1 - 2 / 2.7
    np.testing.assert_allclose(stiffness[0], [end + own, -middle, 0.0], atol=1e-12)
    np.testing.assert_allclose(stiffness[1], [-own, 2 * middle, -own], atol=1e-12)
    np.testing.assert_allclose(damping, [[1.5, -0.5, 0.0], [-0.5, 1.0, -0.5], [0.0, -0.5, 1.5]], atol=1e-12)
