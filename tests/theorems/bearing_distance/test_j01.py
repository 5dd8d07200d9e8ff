"""Erratum J1: the random forest is made of trees."""

import numpy as np

from flockana.measures.nets import components
from flockana.theorems.bearing_distance.j01 import random_forest


def test_the_forest_is_made_of_trees():
    law, q, _ = random_forest(40, 5)
    labels = components(len(q), np.array(law.edges, dtype=np.int32))
    assert labels.max() == 39
    sizes = np.bincount(labels)
    assert sizes.min() >= 2
    assert sizes.max() <= 8
    assert np.bincount([i for _, i in law.edges], minlength=len(q)).max() == 1
