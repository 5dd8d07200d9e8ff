"""Curves between samples: what their control points' hull says of their distance to 0."""

import numpy as np
import pytest

from flockana.kernels.quintic_paths import _hull_bound


@pytest.mark.parametrize("signs", [(1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, -1, -1)])
def test_the_bound_of_a_hull_is_its_distance_along_its_mean_direction(signs):
    """Control points spread across (2, 3, 6), whose length is 7: the curve is nowhere nearer than that."""
    mean, across = np.array([2.0, 3.0, 6.0]), np.array([[3.0, -2.0, 0.0], [6.0, 0.0, -2.0], [0.0, 0.0, 0.0]])
    points = (mean + np.concatenate([across, -across])) * np.array(signs)
    assert _hull_bound(points) == pytest.approx(7.0, rel=1e-15)
    assert _hull_bound(np.tile(mean * signs, (6, 1))) == pytest.approx(7.0, rel=1e-15)


def test_the_nearest_control_point_counts_and_without_a_direction_there_is_no_bound():
    points = np.tile([7.0, 0.0, 0.0], (6, 1))
    points[4] = [1.0, 5.0, 0.0]  # projected on the mean direction (36, 5, 0)
    assert _hull_bound(points) == pytest.approx((36.0 + 25.0) / np.hypot(36.0, 5.0), rel=1e-14)
    assert _hull_bound(np.array([[1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]] * 3)) == 0.0
