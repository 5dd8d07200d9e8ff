"""Alignment of a flock with an equilibrium: a true rotation to the last bit, and the nearest one."""

import numpy as np
import pytest
from flint import arb, ctx
from scipy.spatial.transform import Rotation

from flockana.base.errors import ArgumentError
from flockana.certified.alignment import centred, rotated_to


def turned(angle, m):
    """A rotation in the plane; in space about an axis askew."""
    if m == 2:
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return Rotation.from_rotvec(angle * np.array([0.6, -0.48, 0.64])).as_matrix()


@pytest.mark.parametrize("m", [2, 3])
@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0, -2.9])
def test_the_equilibrium_is_turned_to_the_flock_by_a_true_rotation(angle, m):
    """Lengths and angles stay to 60 digits, though the matrix is proposed in floating point."""
    rest = np.random.default_rng(m).normal(size=(5, m))
    with ctx.workprec(200):
        found = rotated_to(centred("rest", rest, (5, m)), [arb(y) for y in (rest @ turned(angle, m).T).ravel()], (5, m))
        rows, before = ([z[i : i + m] for i in range(0, 5 * m, m)] for z in (found, centred("rest", rest, (5, m))))
        for a in range(5):
            for b in range(a + 1):
                kept, was = (sum(x * y for x, y in zip(z[a], z[b], strict=True)) for z in (rows, before))
                assert kept.overlaps(was)
                assert kept.rad() < 1e-50
        middle = (rest - rest.mean(axis=0)) @ turned(angle, m).T
        np.testing.assert_allclose([float(x) for x in found], middle.ravel(), atol=1e-14)


def test_on_a_line_nothing_turns():
    assert [float(x) for x in rotated_to([arb(-1), arb(1)], [arb(1), arb(-1)], (2, 1))] == [-1.0, 1.0]


@pytest.mark.parametrize("m", [2, 3])
def test_a_mirrored_flock_is_turned_to_as_well_as_a_rotation_can(m):
    """Against the angle of the sum of products in the plane, and scipy's alignment in space."""
    rest = np.array([[1.0, 0.2, 0.3], [-0.4, 1.0, -0.9], [-0.6, -1.2, 0.6]])[:, :m]
    seen = rest * [1.0, -1.0, 1.0][:m] + 0.1 * rest[::-1]
    found = rotated_to(*([arb(y) for y in z.ravel()] for z in (rest, seen)), (3, m))
    best = Rotation.align_vectors(seen, rest)[0].as_matrix() if m == 3 else None
    if m == 2:
        dots, crosses = (rest * seen).sum(), (rest[:, 0] * seen[:, 1] - rest[:, 1] * seen[:, 0]).sum()
        best = turned(np.arctan2(crosses, dots), 2)
    np.testing.assert_allclose([float(x) for x in found], (rest @ best.T).ravel(), atol=1e-13)


def test_the_sum_over_the_agents_is_taken_off():
    assert [float(x) for x in centred("q", [[1.0, 2.0], [4.0, 8.0]], (2, 2))] == [-1.5, -3.0, 1.5, 3.0]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([[1.0, 2.0]], r"x has shape \(1, 2\): expected \(2, 2\), as the equilibrium"),
        ([[1.0], [2.0]], r"x has shape \(2, 1\): expected \(2, 2\)"),
        ([[1.0, np.nan], [0.0, 0.0]], "x holds a number that is not finite: expected finite coordinates"),
    ],
)
def test_other_shapes_and_numbers_are_refused(values, message):
    with pytest.raises(ArgumentError, match=message):
        centred("x", values, (2, 2))
