"""Pair lists of large flocks: all threads list slabs at once, each into its part of the list."""

import numpy as np

from flockana.jit import kernel, parallel, prange, register_jitable
from flockana.kernels.cell_grid import cut_into_slabs, sort_into_grid
from flockana.kernels.verlet_list import MOST, later_agents, list_cells, list_pairs, noted


@register_jitable
def _most_pairs(start, rows, begin, end):
    """Return an upper bound of the number of pairs of the agents in some cells."""
    total = 0
    for cell in range(begin, end):
        cell_count = np.int64(start[cell + 1] - start[cell])
        total += cell_count * later_agents(start, rows, cell) if cell_count > 0 else 0
    return total


@kernel
def list_slabs(q, reach, first, second, cuts):
    """List pairs slab by slab, as `list_pairs`; write the number of slabs and the bounds of each one's pairs."""
    cuts[0], cuts[1], cuts[2], count = 1, 0, 0, 0
    if not reach > 0.0:
        return count
    order, start, rows = sort_into_grid(q, reach)
    x, slabs, limit = np.empty(q.shape), cut_into_slabs(start, rows, cuts), max(reach * reach, 5e-324)
    for i in prange(order.size):
        for c in range(q.shape[1]):
            x[i, c] = q[order[i], c]
    cells, slab_places, slab_ends = cuts[1:].copy(), np.empty(slabs + 1, np.int64), np.empty(slabs, np.int64)
    for s in prange(slabs):
        slab_places[s + 1] = _most_pairs(start, rows, cells[s], cells[s + 1])
    slab_places[0] = 0
    for s in range(slabs):
        slab_places[s + 1] += slab_places[s]
    if slab_places[slabs] > min(first.size, MOST):
        cuts[0], cuts[1], cuts[2] = 1, 0, 0
        if slab_places[slabs] <= MOST:
            return -(slab_places[slabs] + 2)
        count = list_pairs(q, reach, first, second)
        cuts[2] = max(count, 0)
        return count
    for s in prange(slabs):
        cell_range = cells[s], cells[s + 1]
        slab_ends[s] = list_cells(x, (order, start, rows), limit, cell_range, (first, second), slab_places[s])
    for s in range(slabs):
        for k in range(slab_places[s], slab_ends[s]):
            first[count], second[count] = first[k], second[k]
            count += 1
        cuts[s + 2] = count
    return count


parallel_list_slabs = parallel(list_slabs)


@kernel
def listed_in_slabs(q, reach, pairs):
    """Renew a pair list slab by slab, and return the number of pairs, as `listed_anew` does."""
    return noted(list_slabs(q, reach, pairs.first, pairs.second, pairs.cuts), q, reach, pairs)


@kernel
def listed_by_threads(q, reach, pairs):
    """Renew a pair list slab by slab with several threads, as `listed_in_slabs`."""
    return noted(parallel_list_slabs(q, reach, pairs.first, pairs.second, pairs.cuts), q, reach, pairs)
