"""Parameters of the minimal model's edges: forms that are taken, and what is refused."""

import numpy as np

from flockana.measures.perception import ensure_edges
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from tests.refused import refused

TREE = ((0, 1), (1, 2), (1, 3), (0, 4))


test_bad_parameters_name_themselves = refused(
    ({"radius": 0.0}, r"radius = 0: expected a number > 0"),
    ({"radius": (1.0, -1.0)}, r"radius\[1\] = -1: expected a number > 0"),
    ({"spacing": 0.0}, "spacing = 0"),
    ({"beta": 1.0, "spacing": 1.0}, "expected one of them, or neither"),
    ({"mu": -1.0}, "mu = -1: expected a number >= 0"),
    ({"mu": [[1.0, -2.0], [1.0, 1.0]]}, r"mu\[0\]\[1\] = -2"),
    ({"mu": [1.0, 2.0]}, r"mu has shape \(2,\): expected one number, or \(n, n\)"),
    ({"radius": (1.0, 2.0), "spacing": (1.0, 2.0, 3.0)}, "expected tables of equal length"),
    ({"spacing": (1.0, 2.0), "edges": [(0, 2)]}, "edges name agent 2: expected agents below 2"),
    ({"edges": []}, r"edges = \[\]: expected pairs"),
    ({"edges": [(0, 0)]}, r"edges\[0\] = \(0, 0\): expected two different agents"),
    ({"edges": [(0, 1), (0, 1)]}, r"edges\[1\] = \(0, 1\): expected each edge once"),
    ({"edges": [(0, 1.5)]}, r"edges\[0\] = \(0, 1.5\): expected two different agents"),
    ({"edges": 7}, "edges = 7: expected pairs"),
    ({"normalised": 1}, "normalised = 1: expected True or False"),
    ({"sigma": [[0.0, 1.0], [0.0, 0.0]]}, r"sigma\[1\] sums to zero .* for separation alone give sigma=0"),
    ({"edges": [(0, 1)], "sigma": [[0.0, 1.0], [0.0, 0.0]]}, r"sigma\[1\] sums to zero"),
    make=MinimalFlocking,
)


def test_a_silent_root_is_no_mean_without_weights():
    MinimalFlocking(edges=[(0, 1)], sigma=[[0.0, 0.0], [1.0, 0.0]])


def test_edges_are_given_in_any_form():
    assert ensure_edges(np.array(TREE)) == TREE
    assert ensure_edges(iter([[0, 1]])) == ((0, 1),)
