"""Ranks modulo a prime, against exact elimination by sympy."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from flockana.kernels.rank import PRIME, rank_modulo


@pytest.mark.parametrize("seed", range(8))
def test_ranks_of_nets_are_those_of_exact_elimination(seed):
    generator = np.random.default_rng(seed)
    matrix = np.triu(generator.random((9, 9)) < 0.1 + 0.1 * seed, 1).astype(np.int64)
    matrix = matrix + matrix.T
    assert rank_modulo(matrix.copy()) == sp.Matrix(matrix.tolist()).rank()


def test_shapes_zeros_and_pivots_below():
    assert rank_modulo(np.zeros((3, 3), dtype=np.int64)) == 0
    assert rank_modulo(np.array([[0, 0, 2], [0, 3, 0]])) == 2
    assert rank_modulo(np.array([[0, 0], [0, 1], [5, 7], [10, 14]])) == 2
    assert rank_modulo(np.array([[1, 2], [2, 4]])) == 1
    assert rank_modulo(np.array([[PRIME - 1, 1], [1, PRIME - 1]])) == 1  # rows −1, 1 and 1, −1


def test_residues_do_not_overflow():
    big = np.array([[PRIME - 1, PRIME - 2, 3], [PRIME - 3, PRIME - 5, 7], [11, PRIME - 13, PRIME - 17]])
    exact = sp.Matrix([[x - PRIME if x > PRIME // 2 else x for x in row] for row in big.tolist()])
    assert rank_modulo(big.copy()) == exact.rank() == 3
