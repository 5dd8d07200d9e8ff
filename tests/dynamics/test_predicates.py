"""The source's words for groups."""

import numpy as np
import pytest

from flockana import Algorithm1, Trajectory
from flockana.base.errors import ArgumentError
from flockana.dynamics.predicates import is_cohesive, is_dynamic_flock, is_flock, is_quasi_flock


def breaking_up() -> Trajectory:
    """Four agents on a line: together, then three and one, then two and two."""
    q = np.array([[0.0, 7.0, 14.0, 21.0], [0.0, 7.0, 14.0, 40.0], [0.0, 7.0, 50.0, 57.0]])[:, :, None]
    return Trajectory(np.arange(3.0), q, 0 * q, 0 * q, Algorithm1())


def test_the_predicates_see_the_flock_break_up():
    run = breaking_up()
    assert is_flock(run).tolist() == [True, False, False]
    assert is_quasi_flock(run).tolist() == [True, True, False]
    assert is_quasi_flock(run, share=0.8).tolist() == [True, False, False]
    assert not is_dynamic_flock(run)
    assert is_dynamic_flock(run.window(0.0, 0.5))


def test_cohesion_is_about_the_centre_of_mass():
    run = breaking_up()  # radii 10.5, 24.75, 28.5
    assert is_cohesive(run, 28.5)
    assert not is_cohesive(run, 28.4)
    with pytest.raises(ArgumentError, match=r"radius = -1: expected a number > 0"):
        is_cohesive(run, -1.0)
