"""Verified linear algebra: what is certain is found, and what is not certain is not."""

import numpy as np
import pytest
from flint import arb, arb_mat, ctx

from flockana.certified import krawczyk
from flockana.certified.krawczyk import enclose_zero, least_eigenvalue


@pytest.fixture(autouse=True)
def precise():
    with ctx.workprec(128):
        yield


def root_of_two(centre, radius):
    return enclose_zero(
        lambda x: [x[0] * x[0] - 2], lambda x: arb_mat([[2 * x[0]]]), [arb(float(centre))], arb(float(radius))
    )


def test_the_zero_of_a_parabola_is_enclosed_and_none_where_there_is_none():
    (found,) = root_of_two(1.375, 0.125)
    assert found.contains(arb(2).sqrt())
    assert found.rad() < 0.125**2
    assert root_of_two(1.25, 0.125) is None  # √2 is outside
    assert root_of_two(1.625, 0.125) is None
    assert root_of_two(0.25, 2.0) is None  # two of them inside


@pytest.mark.parametrize(("place", "inside"), [(1.0624, True), (1.0625, False), (0.9376, True), (0.9375, False)])
def test_a_zero_on_the_edge_of_the_box_is_not_inside(place, inside):
    found = enclose_zero(lambda x: [x[0] - place], lambda x: arb_mat([[1]]), [arb(1)], arb(0.0625))
    assert (found is not None) is inside
    assert not inside or found[0].contains(arb(place))


def test_a_zero_of_two_equations_is_enclosed_by_what_slopes_leave_open():
    """3x + y = 5 + δ, x + 2y = 5 with an unknown δ of size 1/64: (1, 2) moves by (2, −1) δ/5."""
    slope, off = arb_mat([[3, 1], [1, 2]]), arb(0, arb(1) / 64)
    centre = [arb(1.03125), arb(1.96875)]
    found = enclose_zero(
        lambda x: [3 * x[0] + x[1] - 5 + off, x[0] + 2 * x[1] - 5], lambda x: slope, centre, arb(0.125)
    )
    for sign in (-1, 0, 1):
        exact = 1 + sign * arb(2) / 320, 2 - sign * arb(1) / 320
        assert all(ball.contains(x) for ball, x in zip(found, exact, strict=True))
    assert max(ball.rad() for ball in found) < 0.007


MATRICES = [
    ([[2, 1], [1, 2]], 1.0),
    ([[5, 2, 0], [2, 5, 2], [0, 2, 5]], 5.0 - 8.0**0.5),
    ([[3, -1, -1], [-1, 3, -1], [-1, -1, 3]], 1.0),  # two others alike
]


@pytest.mark.parametrize(("rows", "exact"), MATRICES)
@pytest.mark.parametrize("proposed", [1.0, 3.0, "nearly"])
def test_the_least_eigenvalue_is_bounded_whatever_vectors_are_proposed(monkeypatch, rows, exact, proposed):
    own = np.linalg.eigh

    def other(matrix):
        values, vectors = own(matrix)
        return values, vectors * proposed if proposed != "nearly" else vectors + 1e-3 * np.arange(vectors.size).reshape(
            vectors.shape
        )

    monkeypatch.setattr(krawczyk.np.linalg, "eigh", other)
    found = float(least_eigenvalue(arb_mat(rows)))
    assert exact * (0.9 if proposed == "nearly" else 1.0 - 1e-12) < found <= exact * (1.0 + 1e-15)


def test_balls_count_by_the_worst_matrix_in_them():
    wide = arb_mat([[arb(2, 0.125), arb(1)], [arb(1), arb(2)]])
    exact = 1.9375 - (1.0 + 0.0625**2) ** 0.5  # of [[1.875, 1], [1, 2]]
    assert exact - 0.1 < float(least_eigenvalue(wide)) <= exact


@pytest.mark.parametrize("rows", [[[1, 1], [1, 1]], [[1, 2], [2, 1]], [[-1, 0], [0, 1]], [[arb(1, 1.5), 0], [0, 1]]])
def test_what_is_not_certainly_positive_has_no_bound(rows):
    assert least_eigenvalue(arb_mat(rows)) is None
