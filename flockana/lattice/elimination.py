"""Sparse LDLᵀ factorisation of symmetric matrices over agents by nested dissection.

The agents are halved by the median of their wider coordinate again and again; those of one half that are linked to the
other are the separator, eliminated after both. So every elimination is one of small dense matrices, at the speed of
dense linear algebra. Where a front is not positive definite its own eigenvalues are taken: by Sylvester's law, applied
front by front (Haynsworth 1968), their signs count those of the whole matrix, and with their moduli in their stead the
elimination is that of a positive definite matrix near it, which Newton's method needs to go downhill.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.errors import SolverError
from flockana.base.value_checks import FloatArray

Indices = npt.NDArray[np.int64]

_LEAF = 64  # agents that are eliminated at once
_GROWN = 1e5  # times the largest entry of the matrix: beyond, signs of pivots are those of a matrix 1e-11 of it away
_ZERO = 2.0 * float(np.finfo(np.float64).eps)  # of the largest entry of a front: a pivot below has no sign


class _Front(NamedTuple):
    """Factors of a dense block (front) of a sparse LDLᵀ factorisation, and its coupling to later rows."""

    rows: slice
    boundary: Indices
    t: FloatArray
    x: FloatArray
    signs: FloatArray | None


class Elimination:
    """LDLᵀ factorisation of a symmetric matrix A: the signs of its eigenvalues, and A⁻¹ b."""

    def __init__(
        self, matrix: Any, q: FloatArray, *, keep: bool = True, least: float | None = None, definite: bool = False
    ) -> None:
        n, m = q.shape
        depth = int(np.ceil(np.log2(max(n / _LEAF, 1.0))))
        nodes = list(_bottom_up(1, 2**depth))
        elimination_order = np.zeros(2 ** (depth + 1), dtype=np.int64)
        elimination_order[nodes] = np.arange(len(nodes))
        turns = elimination_order[_dissected(matrix, q, depth)]
        self._order = (m * np.argsort(turns, kind="stable")[:, None] + np.arange(m)).ravel()
        self._matrix = matrix.tocsr()[self._order][:, self._order].tocsr()
        self._largest = float(abs(self._matrix).max())
        self._least, self._definite, self._place = least, definite, np.zeros(n * m, dtype=np.int64)
        self.negative, self._fronts = 0, list[_Front]()
        waiting_blocks: list[tuple[Indices, FloatArray]] = []  # what the last fronts left on their boundaries
        block_ends = m * np.cumsum(np.bincount(turns, minlength=len(nodes)))
        for node, start, end in zip(nodes, [0, *block_ends[:-1].tolist()], block_ends.tolist(), strict=True):
            child_blocks = [waiting_blocks.pop(), waiting_blocks.pop()] if node < 2**depth else []
            front, left = self._eliminated(start, end, child_blocks)
            waiting_blocks.append((front.boundary, left))
            if keep:
                self._fronts.append(front)

    def solve(self, b: FloatArray) -> FloatArray:
        """Return A⁻¹ b of the factorised matrix A, for a vector b or for the columns of a matrix."""
        x = np.array(b[self._order], dtype=np.float64)
        for rows, boundary, t, coupling, signs in self._fronts:
            y = t @ x[rows]
            x[rows] = y if signs is None else (signs * y.T).T
            x[boundary] -= coupling.T @ x[rows]
        for rows, boundary, t, coupling, signs in reversed(self._fronts):
            y = coupling @ x[boundary]
            x[rows] = t.T @ (x[rows] - (y if signs is None else (signs * y.T).T))
        result = np.empty_like(x)
        result[self._order] = x
        return result

    def _eliminated(self, start: int, end: int, below: list[tuple[Indices, FloatArray]]) -> tuple[_Front, FloatArray]:
        """Eliminate the rows of one dense front of the matrix; return the front and the Schur complement."""
        begin, stop = self._matrix.indptr[start], self._matrix.indptr[end]
        columns, values = self._matrix.indices[begin:stop], self._matrix.data[begin:stop]
        rows = np.repeat(np.arange(end - start), np.diff(self._matrix.indptr[start : end + 1]))
        is_later = columns >= start
        columns, values, rows = columns[is_later], values[is_later], rows[is_later]
        touched_columns = np.concatenate([columns[columns >= end], *(at[at >= end] for at, _ in below)])
        boundary = np.unique(touched_columns).astype(np.int64)
        own_size, front_size = end - start, end - start + boundary.size
        self._place[start:end] = np.arange(own_size)
        self._place[boundary] = np.arange(own_size, front_size)
        front = np.zeros((front_size, front_size))
        front[rows, self._place[columns]] = values
        for at, remaining_block in below:
            here = self._place[at]
            front[here[:, None], here] += remaining_block
        largest = float(np.abs(front).max(initial=0.0))
        if self._least is None and largest > _GROWN * self._largest:
            growth = largest / self._largest
            raise SolverError(f"elimination grew entries {growth:.3g} times: the signs of its pivots cannot be trusted")
        t, signs = self._pivots(front[:own_size, :own_size], largest)
        x = t @ front[:own_size, own_size:]
        left = front[own_size:, own_size:] - x.T @ (x if signs is None else signs[:, None] * x)
        return _Front(slice(start, end), boundary, t, x, signs), left

    def _pivots(self, block: FloatArray, largest: float) -> tuple[FloatArray, FloatArray | None]:
        """Return T and S with B⁻¹ = TᵀST of a pivot block B, by Cholesky or by eigenvalues."""
        from scipy.linalg.lapack import dpotrf, dtrtri

        if not len(block):
            return block, None
        factor, failure_code = dpotrf(block, lower=1)
        if not failure_code and (self._least is None or factor.diagonal().min() ** 2 > self._least):
            return dtrtri(factor, lower=1)[0], None
        if self._definite:
            raise SolverError("the matrix is not positive definite")
        eigenvalues, vectors = np.linalg.eigh(block)
        self.negative += int(np.sum(eigenvalues < 0.0))
        if self._least is not None:
            return (vectors / np.sqrt(np.maximum(np.abs(eigenvalues), self._least))).T, None
        if np.abs(eigenvalues).min() <= _ZERO * largest:
            raise SolverError("the sparse elimination met a pivot that is zero to rounding: its sign is undetermined")
        return (vectors / np.sqrt(np.abs(eigenvalues))).T, np.sign(eigenvalues)


def _bottom_up(node: int, leaves: int) -> Iterator[int]:
    """Return the nodes of a binary tree, children before parents (1 is the root, 2k and 2k + 1 are below k)."""
    if node < leaves:
        yield from _bottom_up(2 * node, leaves)
        yield from _bottom_up(2 * node + 1, leaves)
    yield node


def _dissected(matrix: Any, q: FloatArray, depth: int) -> Indices:
    """Return each agent's node in the nested-dissection tree: a leaf, or the separator that holds the agent."""
    n, m = q.shape
    i, j = _agents_linked(matrix, m)
    node = np.ones(n, dtype=np.int64)
    for level in range(depth):
        live = np.flatnonzero(node >= 2**level)
        part = node[live] - 2**level
        low, high = np.full((2**level, m), np.inf), np.full((2**level, m), -np.inf)
        np.minimum.at(low, part, q[live])
        np.maximum.at(high, part, q[live])
        cut_coordinates = q[live, np.argmax(high - low, axis=1)[part]]
        count = np.bincount(part, minlength=2**level)
        rank = np.empty(live.size, dtype=np.int64)
        rank[np.lexsort((cut_coordinates, part))] = np.arange(live.size) - np.repeat(np.cumsum(count) - count, count)
        node[live] = 2 * node[live] + (2 * rank >= count[part])
        is_split = node[i] != node[j]
        node[np.where(node[i] % 2, i, j)[is_split]] //= 2
        in_subtree = (node[i] >= 2 ** (level + 1)) & (node[j] >= 2 ** (level + 1))
        i, j = i[in_subtree], j[in_subtree]
    return node


def _agents_linked(matrix: Any, m: int) -> tuple[Indices, Indices]:
    """Return the pairs i < j of agents coupled by a matrix."""
    from scipy.sparse import coo_array

    entries, n = matrix.tocoo(), matrix.shape[0] // m
    pattern = coo_array((np.ones(entries.nnz, dtype=bool), (entries.row // m, entries.col // m)), shape=(n, n))
    unique_entries = pattern.tocsr().tocoo()
    upper = unique_entries.row < unique_entries.col
    return unique_entries.row[upper].astype(np.int64), unique_entries.col[upper].astype(np.int64)
