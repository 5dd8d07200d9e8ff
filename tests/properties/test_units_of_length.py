"""Nets, lattices and metrics in any unit of length, as far as floating point goes."""

import numpy as np
import pytest

import flockana as fl
from flockana import lattice, metrics
from flockana.base.errors import ArgumentError

Q = np.random.default_rng(0).uniform(0.0, 5.0, (12, 2))
MANY = np.random.default_rng(1).uniform(0.0, 20.0, (320, 2))  # enough for a search tree
R, D = 1.6, 1.0
NET = fl.links(Q, R)

COUNTS = {
    "links": lambda unit: fl.links(Q * unit, R * unit).tolist(),
    "lattice links": lambda unit: lattice.links(Q * unit, R * unit).tolist(),
    "connectivity": lambda unit: fl.connectivity(Q * unit, R * unit),
    "giant share": lambda unit: fl.giant_share(Q * unit, R * unit),
    "coincident pairs": lambda unit: metrics.coincident_pairs(Q * unit, unit),
    "order": lambda unit: fl.order(Q * unit),
    "strain": lambda unit: lattice.strain(Q * unit, D * unit, R * unit),
    "crossings": lambda unit: lattice.crossings(Q * unit, NET).tolist(),
    "rigidity": lambda unit: lattice.rigidity(Q * unit, NET),
    "rigidity by elimination": lambda unit: lattice.rigidity(Q * unit, NET, dense=False),
    "defects": lambda unit: lattice.defects(Q * unit, NET).charge.tolist(),
}
LENGTHS = {
    "cohesion radius": lambda unit: fl.cohesion_radius(Q * unit),
    "least distance": lambda unit: fl.min_distance(Q * unit),
    "least distance of many": lambda unit: fl.min_distance(MANY * unit),
    "diameter": lambda unit: metrics.diameter(Q * unit),
    "edge length error": lambda unit: lattice.edge_length_error(Q * unit, D * unit, R * unit),
    "separation": lambda unit: lattice.separation(Q * unit, NET[[0, -1]], reach=9.0 * unit).distance,
}


@pytest.mark.parametrize("name", [*COUNTS, *LENGTHS])
def test_units_of_length_change_nothing(name):
    for unit in (2.0**power for power in (-990, -500, 500, 990, 1015)):
        if name in COUNTS:
            assert COUNTS[name](unit) == COUNTS[name](1.0), unit
        else:
            assert LENGTHS[name](unit) == LENGTHS[name](1.0) * unit, unit


def test_positions_to_the_end_of_the_numbers():
    far = np.array([[-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0]]) * 1.7e308
    assert lattice.crossings(far, [[0, 1], [2, 3]]).tolist() == [[0, 1]]
    assert lattice.rigidity(far[:3], [[0, 1], [1, 2], [0, 2]]).rank == 3
    with pytest.raises(ArgumentError, match=r"reach 1\.7e\+308, others 4.94e-324: expected one unit"):
        lattice.crossings([*far, [5e-324, 0.0]], [[0, 1], [2, 4]])
    mixed = np.array([[0.0, 0.0], [5e-324, 5e-324], [0.0, 1e290], [1e290, 1e290]])
    assert lattice.crossings(mixed, [[0, 1], [2, 3]]).tolist() == []
    assert lattice.crossings(mixed, [[0, 1], [1, 3], [0, 3]]).tolist() == [[0, 2], [1, 2]]
