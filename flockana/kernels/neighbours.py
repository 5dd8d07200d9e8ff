"""Neighbour search: every pair closer than a range, once, in O(n) time and memory at bounded density.

This is the only place that searches: links, forces, energies and Hessians all loop over the blocks of pairs it
yields. Blocks keep memory O(n) even where every agent is within range of every other. Small flocks are searched
directly; larger ones are sorted into a grid (`flockana.kernels.cell_grid`).
"""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from flockana.jit import kernel
from flockana.kernels.agent_sums import square_between
from flockana.kernels.cell_grid import sort_into_grid

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.int32]

DENSE_MAX = 128  # up to here the direct search is the faster one (benchmarks/search.py)
BLOCK = 8192  # pairs in a block: two index arrays of 32 kB stay in the first-level cache


@kernel
def _fill_direct(x, r2, row, first, second):
    """Fill a block with pairs by testing all from agent `row` on; return (next agent, number of pairs)."""
    n, capacity, count = x.shape[0], first.size, 0
    while row < n and count + n - 1 - row <= capacity:
        for j in range(row + 1, n):
            if square_between(x, row, j) < r2:
                first[count] = row
                second[count] = j
                count += 1
        row += 1
    return row, count


@kernel
def fill_from_grid(x, grid, r2, cell, row, first, second):
    """Fill a block with pairs from agents sorted into a grid; return (cell and row to go on from, number of pairs)."""
    order, start, rows = grid
    n, capacity, count = x.shape[0], first.size, 0
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
                first[count], second[count] = order[row], order[j]
                count += square_between(x, row, j) < r2
        row += 1
    return cell, row, count


def pair_blocks(
    q: FloatArray, r: float, *, dense: bool | None = None, block: int = BLOCK
) -> Iterator[tuple[IndexArray, IndexArray]]:
    """Yield every unordered pair with ‖q_j − q_i‖ < r exactly once, as blocks of index arrays (i, j).

    A block's arrays are reused for the next one: use each before asking for the next.
    """
    n = q.shape[0]
    capacity = max(block, n)
    first_agents, second_agents = np.empty(capacity, np.int32), np.empty(capacity, np.int32)
    if dense is None:
        dense = n <= DENSE_MAX
    r2, row = max(r * r, 5e-324), 0  # r² may underflow: coincident agents are still a pair
    if dense or not np.isfinite(r2):
        while row < n:
            row, count = _fill_direct(q, r2, row, first_agents, second_agents)
            yield first_agents[:count], second_agents[:count]
        return
    grid, cell = sort_into_grid(q, r), 0
    x = q[grid[0]]
    while row < n:
        cell, row, count = fill_from_grid(x, grid, r2, cell, row, first_agents, second_agents)
        yield first_agents[:count], second_agents[:count]


def pair_list(q: FloatArray, r: float) -> tuple[IndexArray, IndexArray]:
    """Return all pairs of `pair_blocks` at once, i < j, in lexicographic order, in O(number of pairs) memory."""
    blocks = [(i.copy(), j.copy()) for i, j in pair_blocks(q, r)]
    i = np.concatenate([b[0] for b in blocks])
    j = np.concatenate([b[1] for b in blocks])
    i, j = np.minimum(i, j), np.maximum(i, j)
    order = np.lexsort((j, i))
    return i[order], j[order]
