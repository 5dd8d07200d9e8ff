"""Every pair closer than a range, once each, in O(n) time and memory at bounded density.

This is the only place that searches: links, forces, energies and Hessians all loop over the blocks of pairs it
yields. Blocks keep memory O(n) even where every agent is within range of every other. Small flocks are searched
directly; larger ones are sorted into a grid of cells of the range's size, or, where the box is too sparse for one, into
cells addressed modulo the table's length, so that one agent far away costs nothing.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from flockana.jit import kernel
from flockana.kernels.grid import sort_into_grid

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.int32]

DENSE_MAX = 128  # up to here the direct search is the faster one (benchmarks/search.py)
BLOCK = 8192  # pairs in a block: two index arrays of 32 kB stay in the first-level cache
_CLAMP = 2.0**40  # farthest cell: agents beyond it share one, which is slow and still right
_MARGIN = 1.0 + 1e-6  # cells a little larger than the range, so that rounding in q/side never skips one

# The cell itself is handled apart; of each two opposite neighbouring cells one is listed.
_FORWARD = np.array(
    [(x, y, z) for z in (0, 1) for y in (-1, 0, 1) for x in (-1, 0, 1) if (z, y, x) > (0, 0, 0)], dtype=np.int64
)


@kernel
def _pad(q):
    x = np.zeros((q.shape[0], 3))
    for i in range(q.shape[0]):
        for k in range(q.shape[1]):
            x[i, k] = q[i, k]
    return x


@kernel
def _fill_direct(x, r2, row, first, second):
    """Fill the block from `row` on; return (row to go on from, pairs found)."""
    n, capacity, count = x.shape[0], first.size, 0
    while row < n and count + n - 1 - row <= capacity:
        for j in range(row + 1, n):
            d0, d1, d2 = x[j, 0] - x[row, 0], x[j, 1] - x[row, 1], x[j, 2] - x[row, 2]
            if d0 * d0 + d1 * d1 + d2 * d2 < r2:
                first[count] = row
                second[count] = j
                count += 1
        row += 1
    return row, count


@kernel
def _sort_into_cells(x, side, size):
    """Counting sort by bucket: (order, sorted positions, sorted cells, bucket starts, strides)."""
    n = x.shape[0]
    cells = np.empty((n, 3), np.int64)
    for i in range(n):
        for k in range(3):
            cells[i, k] = np.int64(np.floor(min(_CLAMP, max(-_CLAMP, x[i, k] / side))))
    strides, total = np.empty(3, np.int64), 1.0
    strides[:] = 1
    for k in range(3):  # row-major cell numbers keep neighbouring cells close in memory ...
        low, high = cells[0, k], cells[0, k]
        for i in range(n):
            low, high = min(low, cells[i, k]), max(high, cells[i, k])
        total *= high - low + 3.0
        if k < 2 and total <= size:
            strides[k + 1] = strides[k] * (high - low + 3)
    if total > size:  # ... but a sparse box is hashed, or whole columns would share a bucket
        strides[1], strides[2] = 73856093, 83492791
    start = np.zeros(size + 1, np.int64)
    bucket = np.empty(n, np.int64)
    for i in range(n):
        b = (cells[i, 0] + cells[i, 1] * strides[1] + cells[i, 2] * strides[2]) & (size - 1)
        bucket[i] = b
        start[b + 1] += 1
    for b in range(size):
        start[b + 1] += start[b]
    fill = start[:-1].copy()
    order = np.empty(n, np.int64)
    for i in range(n):
        order[fill[bucket[i]]] = i
        fill[bucket[i]] += 1
    return order, x[order], cells[order], start, strides


@kernel
def _fill_cells(placed, forward, r2, row, first, second):
    """As `_fill_direct`, over agents of `_sort_into_cells`; a row that does not fit whole waits for the next block."""
    order, x, cells, start, strides = placed
    n, capacity, count, size = x.shape[0], first.size, 0, start.size - 1
    while row < n:
        mark = count
        x0, x1, x2 = x[row, 0], x[row, 1], x[row, 2]
        for f in range(-1, forward.shape[0]):
            c0, c1, c2 = cells[row, 0], cells[row, 1], cells[row, 2]
            if f >= 0:
                c0, c1, c2 = c0 + forward[f, 0], c1 + forward[f, 1], c2 + forward[f, 2]
            b = (c0 + c1 * strides[1] + c2 * strides[2]) & (size - 1)
            begin = row + 1 if f < 0 else start[b]
            for t in range(begin, start[b + 1]):
                d0, d1, d2 = x[t, 0] - x0, x[t, 1] - x1, x[t, 2] - x2
                if d0 * d0 + d1 * d1 + d2 * d2 >= r2:
                    continue
                # two cells may share a bucket: only the one meant counts, or a pair would come twice
                if cells[t, 0] != c0 or cells[t, 1] != c1 or cells[t, 2] != c2:
                    continue
                if count == capacity:
                    return row, mark
                first[count] = order[row]
                second[count] = order[t]
                count += 1
        row += 1
    return row, count


@kernel
def _fill_grid(x, order, start, rows, r2, cell, row, first, second):
    """As `_fill_cells`, over agents sorted into a grid: (cell and row to go on from, pairs found)."""
    (n, m), capacity, count = x.shape, first.size, 0
    while row < n:
        while np.int64(start[cell + 1]) <= row:
            cell += 1
        candidates = np.int64(start[cell + 2]) - row - 1
        for f in range(rows.size):
            there = cell + np.int64(rows[f])
            candidates += np.int64(start[there + 2] - start[there - 1])
        if count + candidates > capacity:
            break
        for f in range(-1, rows.size):
            there = cell + np.int64(rows[f]) if f >= 0 else cell
            low, high = (start[there - 1], start[there + 2]) if f >= 0 else (np.uint64(row + 1), start[cell + 2])
            for j in range(low, high):
                square = 0.0
                for c in range(m):
                    square += (x[j, c] - x[row, c]) ** 2
                first[count], second[count] = order[row], order[j]
                count += square < r2
        row += 1
    return cell, row, count


def pair_blocks(
    q: FloatArray, r: float, *, dense: bool | None = None, block: int = BLOCK
) -> Iterator[tuple[IndexArray, IndexArray]]:
    """Yield every unordered pair with ‖q_j − q_i‖ < r exactly once, as blocks of index arrays (i, j).

    A block's arrays are reused for the next one: use each before asking for the next.

    Examples
    --------
    >>> [(i.tolist(), j.tolist()) for i, j in pair_blocks(np.array([[0.0], [1.0], [5.0]]), 2.0)]
    [([0], [1])]
    """
    n = q.shape[0]
    capacity = max(block, n)
    first, second = np.empty(capacity, np.int32), np.empty(capacity, np.int32)
    if dense is None:
        dense = n <= DENSE_MAX
    x, r2, row = _pad(q), max(r * r, 5e-324), 0  # r² may underflow: coincident agents are still a pair
    if dense or not np.isfinite(r2):
        while row < n:
            row, count = _fill_direct(x, r2, row, first, second)
            yield first[:count], second[:count]
        return
    order, start, rows = sort_into_grid(q, r)
    if start.size:
        sorted_q, cell = q[order], 0
        while row < n:
            cell, row, count = _fill_grid(sorted_q, order, start, rows, r2, cell, row, first, second)
            yield first[:count], second[:count]
        return
    size = 1 << int(2 * n).bit_length()
    parts = _sort_into_cells(x, r * _MARGIN, size)
    forward = _FORWARD[: (1, 4, 13)[q.shape[1] - 1]]
    while row < n:
        row, count = _fill_cells(parts, forward, r2, row, first, second)
        yield first[:count], second[:count]


def pair_list(q: FloatArray, r: float) -> tuple[IndexArray, IndexArray]:
    """All pairs of `pair_blocks` at once, i < j, in lexicographic order: O(number of pairs) memory.

    Examples
    --------
    >>> i, j = pair_list(np.array([[0.0], [1.0], [1.5]]), 1.2)
    >>> i.tolist(), j.tolist()
    ([0, 1], [1, 2])
    """
    blocks = [(i.copy(), j.copy()) for i, j in pair_blocks(q, r)]
    i = np.concatenate([b[0] for b in blocks])
    j = np.concatenate([b[1] for b in blocks])
    i, j = np.minimum(i, j), np.maximum(i, j)
    order = np.lexsort((j, i))
    return i[order], j[order]
