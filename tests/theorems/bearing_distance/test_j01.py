"""Erratum J1: every random tree goes to its desired lengths, and the forest is made of trees."""

import numpy as np
import pytest

from flockana.measures.nets import components
from flockana.theorems.bearing_distance.j01 import random_forest


def test_every_tree_ends_at_its_spacing_and_none_at_zero(verdict_of):
    claim = verdict_of("J1").claim("corrected")
    assert claim.computed["trees"] == 200
    # 200 of 200: the exact lower end is (α/2)^(1/200)
    assert claim.computed["interval"][0] == pytest.approx(0.025 ** (1 / 200))
    assert verdict_of("J1").claim("printed").computed["trees whose edges might all vanish"] == 0


def test_the_forest_is_made_of_trees():
    law, q, _ = random_forest(40, 5)
    labels = components(len(q), np.array(law.edges, dtype=np.int32))
    assert labels.max() == 39
    sizes = np.bincount(labels)
    assert sizes.min() >= 2
    assert sizes.max() <= 8
    assert np.bincount([i for _, i in law.edges], minlength=len(q)).max() == 1
