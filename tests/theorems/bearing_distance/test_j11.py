"""Erratum J11: the random start of the minimal model."""

import numpy as np

from flockana.theorems.bearing_distance.j11 import minimal_start
from tests.adversarial.published import changes


def test_starts_are_what_they_say_and_reproducible():
    q, p = minimal_start(2, 0)
    assert q.max() < 30.0
    assert p.min() < -0.9
    np.testing.assert_array_equal(minimal_start(2, 7)[0], minimal_start(2, 7)[0])


def test_it_says_what_was_published(verdict_of):
    assert changes(verdict_of("J11")) == []
