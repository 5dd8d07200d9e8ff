"""Errata J1, J3, J7, J11 and J17: what their checks are made of, against calculations by hand."""

from math import tanh

import numpy as np
import pytest

from flockana.measures.nets import components
from flockana.theorems.bearing_distance.j01 import random_forest
from flockana.theorems.bearing_distance.j03 import path_matrices
from flockana.theorems.bearing_distance.j07 import dragged_speed
from flockana.theorems.bearing_distance.j11 import minimal_start
from flockana.theorems.bearing_distance.j17 import first_step
from tests.adversarial.published import changes


def test_the_forest_is_made_of_trees():
    law, q, _ = random_forest(40, 5)
    labels = components(len(q), np.array(law.edges, dtype=np.int32))
    assert labels.max() == 39
    sizes = np.bincount(labels)
    assert sizes.min() >= 2
    assert sizes.max() <= 8
    assert np.bincount([i for _, i in law.edges], minlength=len(q)).max() == 1


def test_the_path_of_four():
    stiffness, damping = path_matrices(1.0)
    # by hand: ends want 1 and have 2.05, the middle ones want 2; an edge's row is minus the difference of two agents
    end, own, middle = 1 - 1 / 2.05, 1 - 2 / 2.05, 1 - 2 / 2.7
    np.testing.assert_allclose(stiffness[0], [end + own, -middle, 0.0], atol=1e-12)
    np.testing.assert_allclose(stiffness[1], [-own, 2 * middle, -own], atol=1e-12)
    np.testing.assert_allclose(damping, [[1.5, -0.5, 0.0], [-0.5, 1.0, -0.5], [0.0, -0.5, 1.5]], atol=1e-12)


def test_the_drag():
    assert dragged_speed(0.1) == pytest.approx(2.0083, abs=5e-5)
    speeds = [dragged_speed(dt) for dt in (0.05, 0.01, 0.001)]
    np.testing.assert_allclose(speeds, [1.628, 0.974, 0.457], atol=1e-3)  # found by iteration, to three digits
    v = dragged_speed(0.1)
    assert 4.0 * tanh((v + 0.2) / 4.0) == pytest.approx(v, abs=1e-12)


def test_starts_are_what_they_say_and_reproducible():
    q, p = minimal_start(2, 0)
    assert q.max() < 30.0
    assert p.min() < -0.9
    np.testing.assert_array_equal(minimal_start(2, 7)[0], minimal_start(2, 7)[0])


def test_it_says_what_was_published(verdict_of):
    assert changes(verdict_of("J11")) == []


def test_what_never_happens_has_no_first_step():
    """Its number would be 0 by argmax, and two such would have no delay."""
    assert first_step(np.array([False, False, True, True])) == 2.0
    assert np.isnan(first_step(np.zeros(3, dtype=bool)))
