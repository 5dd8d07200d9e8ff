"""Candidate neighbours of an agent in index order, so that sums equal sums over all agents exactly."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.jit import kernel
from flockana.kernels.cell_grid import sort_into_grid

IndexArray = npt.NDArray[np.int64]

_FEW = 64  # flocks up to this size are searched agent by agent
_CROWDED = 4  # least number of blocks of adjacent cells; with fewer, most agents are near each other
_SLACK = 1.0 + 1e-9  # for who is near by the rounding of a root


class Cells(NamedTuple):
    """Agents by cell, first agent of each cell, offsets of later adjacent cell rows, and each agent's cell."""

    order: IndexArray
    start: IndexArray
    rows: IndexArray
    cell: IndexArray


@kernel
def sort_into_cells(q, reach):
    """Return the cells of a flock; four empty arrays for small flocks, which test all agents."""
    n, m = q.shape
    no_agents = np.empty(0, np.int64)
    if n <= _FEW:
        return Cells(no_agents, no_agents, no_agents, no_agents)
    order, start, rows = sort_into_grid(q, reach)
    if start.size <= _CROWDED * 3**m:
        return Cells(no_agents, no_agents, no_agents, no_agents)
    cell = np.empty(n, np.int64)
    for c in range(start.size - 1):
        for k in range(start[c], start[c + 1]):
            cell[order[k]] = c
    return Cells(order.astype(np.int64), start.astype(np.int64), rows.astype(np.int64), cell)


@kernel
def gather(i, q, reach, cells, near):
    """Write the indices of agents possibly within reach of agent i (included) to `near`; return the count."""
    n, m = q.shape
    if cells.start.size == 0:
        for k in range(n):  # an instant before this one may have had cells
            near[k] = k
        return n
    count, c, squared_reach = 0, cells.cell[i], reach * reach * _SLACK
    for row in range(-cells.rows.size, cells.rows.size + 1):
        offset = 0 if row == 0 else cells.rows[row - 1] if row > 0 else -cells.rows[-row - 1]
        for k in range(cells.start[c + offset - 1], cells.start[c + offset + 2]):
            j, d2 = cells.order[k], 0.0
            for axis in range(m):
                d2 += (q[j, axis] - q[i, axis]) ** 2
            near[count] = j
            count += d2 <= squared_reach
    _sort(near, count)
    return count


@kernel
def _sort(near, count):
    """Sort `count` indices in place by Shell's method, few ones by insertion."""
    gap = 1
    while count > _FEW and gap < count // 9:
        gap = 3 * gap + 1
    while gap > 0:
        for k in range(gap, count):
            j, insert_index = near[k], k
            while insert_index >= gap and near[insert_index - gap] > j:
                near[insert_index] = near[insert_index - gap]
                insert_index -= gap
            near[insert_index] = j
        gap //= 3
