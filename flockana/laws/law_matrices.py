"""Sparse matrices of laws: blocks of single agents, and sums of terms' derivatives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.value_checks import FloatArray

if TYPE_CHECKING:
    from scipy.sparse import csr_array


def block_diagonal(blocks: FloatArray) -> csr_array:
    """Return a sparse matrix with one block for each agent on its diagonal.

    Parameters
    ----------
    blocks : ndarray, shape (n, m, m)
        What each agent feels of itself.

    Examples
    --------
    >>> block_diagonal(np.array([[[2.0]], [[3.0]]])).toarray().tolist()
    [[2.0, 0.0], [0.0, 3.0]]
    """
    from scipy.sparse import bsr_array

    n, m = blocks.shape[:2]
    return bsr_array((blocks, np.arange(n), np.arange(n + 1)), shape=(n * m, n * m)).tocsr()


def assembled(parts: Any) -> Any:
    """Return the sum of sparse matrices and of diagonal blocks of single agents."""
    matrices, blocks = ([x for x in parts if isinstance(x, np.ndarray) == is_dense] for is_dense in (False, True))
    if blocks:
        matrices.append(block_diagonal(sum(blocks[1:], blocks[0])))
    return sum(matrices[1:], matrices[0]).tocsr()
