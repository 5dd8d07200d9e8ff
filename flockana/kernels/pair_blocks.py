"""Potential and derivatives of a pair law over a block of pairs: a template (`flockana.kernels.bound_templates`).

The potential of a large flock is summed slab by slab, by one thread or by several.
"""

from zlib import crc32

import numpy as np

from flockana.jit import kernel, parallel, prange, register_jitable
from flockana.kernels.agent_sums import square_between
from flockana.kernels.alpha import norm_alpha as norm  # bound
from flockana.kernels.alpha import pair_alpha_potential as potential  # bound
from flockana.kernels.alpha import pair_alpha_slope as slope  # bound
from flockana.kernels.alpha import stress_alpha as pair  # bound
from flockana.kernels.cell_grid import cut_into_slabs, empty_cuts, later_in_row, sort_into_grid

NORMED = True  # bound
OWN = np.zeros(0, f"S{crc32(__name__.encode()) % 2**24 + 1}")  # as in `flockana.kernels.pair_sums`


@kernel
def energy(q, i, j, par, panels):
    """Return the potential Σ ψ over the pairs of a block."""
    total = 0.0
    for k in range(i.size):
        total += potential(square_between(q, i[k], j[k]), par, panels)
    return total


@register_jitable
def _put_agent(own, q, order, k, x):
    """Write the position of an agent of a sorted flock."""
    for c in range(q.shape[1]):
        x[k, c] = q[order[k], c]


@register_jitable
def _energy_in_slab(own, low, high, start, rows, x, limit, numbers, sums):
    """Write Σ ψ between the agents in some cells and later ones within range, and the number of pairs."""
    (par, panels), total, pairs = numbers, 0.0, 0
    for cell in range(low, high):
        for i in range(start[cell], start[cell + 1]):
            for row in range(-1, np.int64(rows.size)):
                begin, end = later_in_row(start, rows, cell, i, row)
                for j in range(begin, end):
                    squared_value = square_between(x, i, j)
                    if squared_value < limit:
                        total += potential(squared_value, par, panels)
                        pairs += 1
    sums[0], sums[1] = total, pairs


@kernel
def energy_in_slabs(q, r, par, panels):
    """Return the potential Σ ψ over all pairs of a large flock within r, and their number."""
    order, start, rows = sort_into_grid(q, r)
    x, slab_cuts, marker, limit = np.empty(q.shape), empty_cuts(q.shape[0]), OWN[:0], max(r * r, 5e-324)
    slabs, total, pairs = cut_into_slabs(start, rows, slab_cuts), 0.0, np.int64(0)
    sums = np.empty((slabs, 2))
    for k in prange(order.size):
        _put_agent(marker, q, order, np.int64(k), x)
    for s in prange(slabs):
        _energy_in_slab(marker, slab_cuts[s + 1], slab_cuts[s + 2], start, rows, x, limit, (par, panels), sums[s])
    for s in range(slabs):
        total, pairs = total + sums[s, 0], pairs + np.int64(sums[s, 1])
    return total, pairs


parallel_energy_in_slabs = parallel(energy_in_slabs)


@kernel
def terms(q, i, j, par):
    """Return weight w, adjacency a and dw/d(s²) of each pair of a block, shape (3, L)."""
    output = np.empty((3, i.size))
    for k in range(i.size):
        s2 = square_between(q, i[k], j[k])
        if NORMED:
            z, root = norm(s2, par)
            output[0, k], output[1, k] = pair(z, root, par)
        else:
            output[0, k], output[1, k] = pair(s2, par)
        output[2, k] = slope(s2, par)
    return output
