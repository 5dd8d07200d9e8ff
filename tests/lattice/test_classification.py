"""Edge-length error, classification, coordination and defects."""

from itertools import permutations

import numpy as np
import pytest

from flockana.lattice import coordination, defects, hexagonal_patch, triangular
from flockana.lattice.classification import classify, edge_length_error, is_alpha_lattice, links, strain
from tests.refused import refused

D, R = 7.0, 8.4


def test_the_error_is_the_worst_link_either_way():
    q = np.array([[0.0], [6.0], [13.5]])
    assert edge_length_error(q, D, R) == 1.0
    assert strain(q, D, R) == pytest.approx(1.0 / 7.0)
    assert edge_length_error([[0.0], [8.3]], D, R) == pytest.approx(1.3)


def test_without_links_nothing_is_a_lattice():
    assert np.isnan(edge_length_error([[0.0], [100.0]], D, R))
    assert not is_alpha_lattice([[0.0], [100.0]], D, R)
    assert classify(float("nan"), lattice=1.0, quasi=1.0) == "neither"


test_bad_input = refused(
    (lambda: classify("x", lattice=0.1, quasi=0.2), "strain = 'x': expected one real number"),
    (lambda: classify(0.3, lattice=0.1, quasi=None), "quasi = None: expected one real number"),
    (lambda: links([[0.0]], R, guard=-1e-3), "guard"),
    (lambda: links([[0.0]], R, guard=1.0), "guard"),
    (lambda: defects(np.zeros((2, 3)), []), "q has 3 columns: expected 2"),
)


def test_the_bounds_of_the_names_belong_to_them():
    above = [np.nextafter(bound, 1.0) for bound in (0.25, 0.5)]
    named = [classify(strain, lattice=0.25, quasi=0.5) for strain in (0.25, above[0], 0.5, above[1])]
    assert named == ["α-lattice", "quasi-α-lattice", "quasi-α-lattice", "neither"]


def test_the_tolerance_is_relative_to_d():
    q = [[0.0], [D * (1.0 + 1e-7)]]
    assert not is_alpha_lattice(q, D, R)
    assert is_alpha_lattice(q, D, R, tol=2e-7)


def test_coordination_of_a_hexagon():
    assert coordination(7, links(hexagonal_patch(1, D), R)).tolist() == [6, 3, 3, 3, 3, 3, 3]
    assert coordination(3, []).tolist() == [0, 0, 0]


@pytest.mark.parametrize("sides", [3, 4, 5, 6, 7, 8])
def test_a_wheel_has_the_charge_of_its_missing_sides(sides):
    angle = 2.0 * np.pi * np.arange(sides) / sides
    q = np.concatenate([[[0.0, 0.0]], np.column_stack([np.cos(angle), np.sin(angle)])])
    spokes = [[0, k] for k in range(1, sides + 1)]
    rim = [[k, k % sides + 1] for k in range(1, sides + 1)]
    found = defects(q, spokes + rim)
    assert found.interior.tolist() == [True] + sides * [False]
    assert found.charge.tolist() == [6 - sides] + sides * [0]
    assert found.counts == {sides: 1}
    assert not defects(q, spokes + rim[1:]).interior.any()  # one face is open


def test_the_rim_of_a_patch_has_no_charge():
    q = triangular(100, D)
    found = defects(q, links(q, R))
    assert found.counts == {6: 64}
    assert not found.charge.any()


def test_a_vacancy_is_a_hole_and_its_neighbours_are_not_defects():
    q = np.delete(hexagonal_patch(3, D), 0, axis=0)
    found = defects(q, links(q, R))
    assert found.counts == {6: 12}  # 37 agents: 18 at the rim, 6 at the hole, 1 gone
    assert sorted(set(found.coordination.tolist())) == [3, 4, 5, 6]


def test_an_open_face_is_seen_however_the_agents_are_numbered():
    """A wheel of four with each of its rim's links missing, in every order of its agents."""
    q = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    spokes, rim = [[0, k] for k in range(1, 5)], [[1, 2], [2, 3], [3, 4], [4, 1]]
    for order in permutations(range(5)):
        number = np.array(order)
        placed = np.empty_like(q)
        placed[number] = q
        assert defects(placed, number[spokes + rim]).interior.nonzero()[0].tolist() == [number[0]]
        for k in range(4):
            assert not defects(placed, number[spokes + rim[:k] + rim[k + 1 :]]).interior.any()


def test_defects_without_links():
    assert not defects([[0.0, 0.0]], []).interior.any()


def test_a_triangle_that_does_not_go_around_is_not_interior():
    """All neighbours on one side, linked in a row and across: the gap behind is more than half a turn."""
    q = [[0.0, 0.0], [1.0, -0.8], [1.0, 0.0], [1.0, 0.8]]
    assert not defects(q, [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3], [1, 3]]).interior[0]


@pytest.mark.parametrize("tilt", np.linspace(0.0, 3.0, 13))
def test_a_triangle_folded_onto_its_agent_does_not_surround_it(tilt):
    """Of three neighbours two stand opposite each other to the last bit: the half turn between them is no triangle."""
    along = np.array([np.cos(tilt), np.sin(tilt)])
    across = np.array([-along[1], along[0]])
    q = np.array([0.0 * along, along, -along, across])
    links_ = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
    assert not defects(q, links_).interior[0]
    for off, around in ((-1e-9, True), (1e-9, False)):
        bent = q.copy()
        bent[2] += off * across
        assert defects(bent, links_).interior[0] == around
