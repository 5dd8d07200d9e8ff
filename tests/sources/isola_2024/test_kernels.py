"""Neighbour lists of the map that moves agents one after the other."""

import numpy as np
import pytest

from flockana.sources.isola_2024.kernels import neighbour_lists


@pytest.mark.parametrize("function", [neighbour_lists, neighbour_lists.py_func])
def test_neighbours_stand_in_the_order_of_the_pairs(function):
    start, neighbour = function(4, np.array([0, 0, 1], dtype=np.int32), np.array([3, 1, 3], dtype=np.int32))
    assert (start.tolist(), neighbour.tolist()) == ([0, 2, 4, 4, 6], [3, 1, 0, 3, 0, 1])
