"""Rigidity of frameworks whose answer is known, densely and sparsely."""

import numpy as np
import pytest

from flockana.base.errors import SolverError
from flockana.lattice import Rigidity, links, rigidity, rigidity_matrix
from flockana.lattice.builders import fcc, hexagonal_patch, honeycomb, line, simple_cubic, square, triangular
from flockana.lattice.rigidity import eigenvalues_below, rigid_motion_count

OCTAHEDRON = np.concatenate([np.eye(3), -np.eye(3)])
CASES = {
    # n m − rank − rigid motions = flexes; links − rank = self-stresses
    "a pair": (line(2, 7.0), 8.4, Rigidity(1, 1, 0, 0, 0)),
    "a line": (line(9, 7.0), 8.4, Rigidity(8, 1, 0, 0, 0)),
    "three on a line in the plane": (np.array([[0.0, 0.0], [7.0, 0.0], [14.0, 0.0]]), 8.4, Rigidity(2, 3, 1, 0, 0)),
    "a triangle": (triangular(3, 7.0), 8.4, Rigidity(3, 3, 0, 0, 0)),
    "a hexagon": (hexagonal_patch(1, 7.0), 8.4, Rigidity(11, 3, 0, 1, 0)),
    "a square grid": (square(4, 5, 7.0), 8.4, Rigidity(31, 3, 6, 0, 0)),  # rows + cols − 3 shears
    "a honeycomb": (honeycomb(3, 3, 7.0), 8.4, Rigidity(21, 3, 12, 0, 0)),  # 21 links, all independent
    "two apart": (np.array([[0.0, 0.0], [100.0, 0.0]]), 8.4, Rigidity(0, 3, 1, 0, 0)),
    "an octahedron": (OCTAHEDRON, 1.5, Rigidity(12, 6, 0, 0, 0)),
    "an octahedron with its diagonals": (OCTAHEDRON, 2.5, Rigidity(12, 6, 0, 3, 0)),
    "FCC": (fcc(2, 2, 2, 7.0), 8.4, Rigidity(90, 6, 0, 18, 0)),
    "cubes": (simple_cubic(2, 2, 2, 7.0), 8.4, Rigidity(12, 6, 6, 0, 0)),
    "a point in space": (np.zeros((1, 3)), 1.0, Rigidity(0, 3, 0, 0, 0)),
    "coincident": (np.zeros((2, 2)), 1.0, Rigidity(0, 2, 2, 1, 0)),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("dense", [True, False])
def test_known_frameworks(name, dense):
    q, r, expected = CASES[name]
    found = rigidity(q, links(q, r), dense=dense)
    assert found == expected
    assert found.infinitesimally_rigid == (expected.flexes == 0)


def test_the_matrix_is_the_rate_of_the_lengths():
    rng = np.random.default_rng(0)
    q, v = rng.uniform(0.0, 20.0, (8, 3)), rng.normal(size=(8, 3))
    pairs, step = links(q, 15.0), 1e-6
    lengths = [np.linalg.norm((q + s * v)[pairs[:, 1]] - (q + s * v)[pairs[:, 0]], axis=1) for s in (step, -step)]
    np.testing.assert_allclose(
        rigidity_matrix(q, pairs) @ v.ravel(), (lengths[0] - lengths[1]) / (2.0 * step), atol=1e-8
    )


def test_a_large_patch_is_rigid_and_has_a_stress_for_each_hexagon():
    q = triangular(2500, 7.0)
    found = rigidity(q, links(q, 8.4))
    assert found == Rigidity(4997, 3, 0, 48 * 48, 0)


def test_a_nearly_flexible_triangle_is_called_soft():
    """Three on a line but for a bend of 3e-5: one singular value of about that size, a little above the threshold."""
    q = np.array([[0.0, 0.0], [1.0, 3e-5], [2.0, 0.0]])
    found = rigidity(q, [[0, 1], [1, 2], [0, 2]])
    assert (found.flexes, found.soft) == (0, 1)
    assert rigidity(q, [[0, 1], [1, 2], [0, 2]], tol=1e-4).flexes == 1


@pytest.mark.parametrize(("m", "flat", "count"), [(1, 1, 1), (2, 1, 3), (2, 2, 3), (3, 1, 5), (3, 2, 6), (3, 3, 6)])
def test_rigid_motions_depend_on_the_affine_hull(m, flat, count):
    q = np.zeros((7, m))
    q[:, :flat] = np.random.default_rng(m).normal(size=(7, flat))
    assert rigid_motion_count(q + 1e3) == count


@pytest.mark.parametrize(("thin", "count"), [(1e-7, 6), (1e-11, 5)])
@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e9])
def test_what_counts_as_a_line_in_space_is_a_billionth_of_its_length_in_every_unit(unit, thin, count):
    """And as well a thousand lengths from the origin, where coordinates round to less than that."""
    bent = np.array([[0.0, 0.0, 0.0], [1.0, thin, 0.0], [2.0, 0.0, 0.0]])
    assert rigid_motion_count(unit * bent) == count
    assert rigid_motion_count(unit * (bent + 1e3)) == count


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e9])
def test_agents_in_one_place_are_a_point_whatever_their_mean_rounds_to(unit):
    """The mean of three times 0.1 is more than 0.1."""
    assert rigid_motion_count(np.full((3, 3), 0.1 * unit)) == 3


def test_a_zero_pivot_is_a_failure_and_no_answer():
    """A shift that is an eigenvalue of the first block: 1 − 1 = 0 on the diagonal."""
    from scipy.sparse import csr_array

    with pytest.raises(SolverError, match="use another tol, or dense=True"):
        eigenvalues_below(csr_array(np.eye(2)), 1.0, np.zeros((1, 2)))


@pytest.mark.parametrize("height", [1e-2, 1e-3])
def test_a_soft_motion_below_the_threshold_counts_as_one_in_both_ways(height):
    """A flat triangle bends softly: with a threshold of twice its softest singular value it is not rigid."""
    q, net = np.array([[0.0, 0.0], [1.0, height], [2.0, 0.0]]), [[0, 1], [1, 2], [0, 2]]
    sizes = np.linalg.svd(rigidity_matrix(q, net).toarray(), compute_uv=False)
    tol = 2.0 * sizes[-1] / sizes[0]
    for dense in (True, False):
        assert rigidity(q, net, dense=dense).infinitesimally_rigid
        assert not rigidity(q, net, tol=tol, dense=dense).infinitesimally_rigid
