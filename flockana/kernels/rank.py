"""The rank of a matrix of whole numbers, modulo a prime: exact arithmetic, the same on every machine."""

from __future__ import annotations

from flockana.kernels.compiling import njit

PRIME = 2147483647  # 2³¹ − 1: products of two residues fit 64 bits


@njit(cache=True)
def rank_modulo(matrix):
    """Rank over the field of PRIME elements of an int64 matrix with entries in [0, PRIME), which is overwritten.

    It never exceeds the rank, and falls short of it only if PRIME divides every minor of that size.
    """
    rows, columns = matrix.shape
    rank = 0
    for c in range(columns):
        pivot = rank
        while pivot < rows and matrix[pivot, c] == 0:
            pivot += 1
        if pivot == rows:
            continue
        inverse, power, base = 1, PRIME - 2, matrix[pivot, c]  # Fermat: x^(p − 2) is 1/x
        while power > 0:
            if power & 1:
                inverse = inverse * base % PRIME
            base = base * base % PRIME
            power >>= 1
        for k in range(c, columns):
            matrix[pivot, k], matrix[rank, k] = matrix[rank, k], matrix[pivot, k] * inverse % PRIME
        for i in range(rank + 1, rows):
            factor = matrix[i, c]
            if factor != 0:
                for k in range(c, columns):
                    matrix[i, k] = (matrix[i, k] - factor * matrix[rank, k]) % PRIME
        rank += 1
        if rank == rows:
            break
    return rank
