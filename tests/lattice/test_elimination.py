"""Elimination by nested dissection against dense linear algebra: signs, solutions, and the positive matrix near it."""

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array, eye_array

from flockana.base.errors import SolverError
from flockana.lattice import links, rigidity_matrix
from flockana.lattice.elimination import Elimination


def shifted(n: int, m: int, shift: float, seed: int = 0):
    """RᵀR − shift of a random net in several pieces, with agents that have no link, two at one place, one far off."""
    q = np.random.default_rng([n, m, seed]).uniform(0.0, 7.0 * n ** (1.0 / m), (n, m))
    q[1] = q[0]
    q[-1] += 1e6
    matrix = rigidity_matrix(q, links(q, 10.0))
    return q, csr_array(matrix.T @ matrix - shift * eye_array(q.size))


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [3, 64, 65, 300])
def test_signs_and_solutions_are_those_of_the_dense_matrix(n, m):
    for shift in (0.3, -0.1):
        q, matrix = shifted(n, m, shift)
        found, dense = Elimination(matrix, q), matrix.toarray()
        sizes = np.linalg.eigvalsh(dense)
        assert np.abs(sizes).min() > 1e-9  # so that the signs below are a matter of mathematics
        assert found.negative == np.sum(sizes < 0.0)
        b = np.random.default_rng(1).standard_normal((q.size, 2))
        condition = np.abs(sizes).max() / np.abs(sizes).min()
        for right in (b, b[:, 0]):
            expected = np.linalg.solve(dense, right)
            np.testing.assert_allclose(found.solve(right), expected, atol=1e-13 * condition * np.abs(expected).max())


@pytest.mark.parametrize("m", [1, 2])
def test_agents_are_halved_so_no_front_is_large(m):
    """1600 on a square lattice or a line: a leaf has 64 at most, the widest separator is one row of 40."""
    side = 40 if m == 2 else 1600
    q = np.stack(np.meshgrid(*[np.arange(side, dtype=float)] * m, indexing="ij"), axis=-1).reshape(-1, m)
    matrix = rigidity_matrix(q, links(q, 1.5))
    fronts = Elimination(csr_array(matrix.T @ matrix + eye_array(q.size)), q)._fronts
    assert max(front.rows.stop - front.rows.start for front in fronts) <= 64 * m
    assert max(front.boundary.size for front in fronts) <= 4 * 42 * m


def test_a_long_link_is_no_trouble():
    """Places decide about the time only: here the two ends of a chain are linked, and agents stand in no order."""
    n = 500
    order = np.random.default_rng(0).permutation(n)
    matrix = np.zeros((n, n))
    for k in range(n):
        i, j = order[k], order[(k + 1) % n]
        matrix[i, i] += 1.0
        matrix[j, j] += 1.0
        matrix[i, j] -= 1.0
        matrix[j, i] -= 1.0
    shift = 2.0 - 2.0 * np.cos(2.0 * np.pi * 10.5 / n)  # between the eigenvalues 2 − 2cos(2πk/n) of k = 10 and 11
    found = Elimination(csr_array(matrix - shift * np.eye(n)), np.arange(float(n))[:, None])
    assert found.negative == 21


def test_with_moduli_it_is_a_positive_matrix_and_of_a_positive_one_that_itself():
    q, matrix = shifted(300, 2, 0.3)
    b = np.random.default_rng(2).standard_normal((q.size, 5))
    down = Elimination(matrix, q, least=1e-3).solve(b)
    assert np.linalg.eigvalsh(b.T @ down).min() > 0.0
    q, matrix = shifted(300, 2, -0.1)
    plain, with_least = (Elimination(matrix, q, **kept).solve(b) for kept in ({}, {"least": 1e-3}))
    np.testing.assert_allclose(with_least, plain, rtol=1e-9, atol=1e-11)


def test_a_pivot_without_a_sign_is_an_error():
    with pytest.raises(SolverError, match="zero to rounding"):
        Elimination(csr_array((2, 2)), np.zeros((1, 2)))


def test_nothing_is_kept_where_only_signs_are_asked_for():
    q, matrix = shifted(300, 2, 0.3)
    assert Elimination(matrix, q, keep=False).negative == Elimination(matrix, q).negative


def test_signs_that_rounding_has_eaten_are_not_counted():
    """A chain whose first half alone is singular but for 1e-12: what is eliminated after it grows by as much."""
    chain = diags_array([-np.ones(127), np.full(128, 2.0), -np.ones(127)], offsets=(-1, 0, 1)).tocsr()
    q, refused = np.arange(128.0)[:, None], 0
    for half in (62, 63, 64, 65):  # as many agents as may be in the first leaf
        shift = float(np.linalg.eigvalsh(chain.toarray()[:half, :half])[0]) + 1e-12
        moved = chain - shift * eye_array(128)
        try:
            assert Elimination(moved, q).negative == int(np.sum(np.linalg.eigvalsh(moved.toarray()) < 0.0))
        except SolverError as error:
            assert "grew entries" in str(error)  # noqa: PT017  # of which of them hangs on the dissection
            refused += 1
    assert refused >= 1
