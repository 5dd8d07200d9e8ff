"""Verlet list: pairs within a range plus a skin, valid until relative displacements exceed the skin.

A list is a half list of two index arrays with room to spare, which kernels fill in place. Agents sorted by cell keep
what a pair needs close in memory.
"""

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import inlined, kernel, register_jitable, subroutine
from flockana.kernels.agent_sums import slope_along
from flockana.kernels.cell_grid import empty_cuts, later_in_row, sort_into_grid


class Pairs(NamedTuple):
    """Pair list filled by kernels: two index arrays, reference positions and reach, and counts."""

    first: Any  # uint32
    second: Any
    places: Any  # (n, m): where the agents were
    reach: Any  # (1,): the pairs closer than this are listed; 0 of an empty list
    cuts: Any  # int64: number of slabs, and where the pairs of each begin and those of the last end
    counts: Any  # (2,), int64: of pairs, or as `list_pairs` returns it where they do not fit; of lists made so far


COUNT, MADE = range(2)  # of the counts
CROWDED = -1  # a count: more pairs than memory holds
_ROOM = 8  # pairs an agent, to begin with
SKIN = 0.15  # of the range: what a list holds beyond it, so that it lasts some steps
MOST = 2**27  # room for pairs, at most: a gigabyte


def spatial_order(q: Any, side: float) -> Any:
    """Return an order of the agents that keeps the agents of a cell together."""
    return sort_into_grid(q, side)[0]


@inlined
def later_agents(start, rows, cell):
    """Return an upper bound of the number of agents listed with one agent of a cell."""
    count = np.int64(start[cell + 2] - start[cell])
    for row in range(rows.size):
        neighbour_cell = np.int64(cell) + np.int64(rows[row])
        count += np.int64(start[neighbour_cell + 2] - start[neighbour_cell - 1])
    return count


@register_jitable
def list_cells(x, grid, limit, cells, lists, count):
    """List the pairs of agents in some cells from an index on; return the end index, or an overflow code."""
    (order, start, rows), (first_agents, second_agents), m = grid, lists, x.shape[1]
    for cell in range(cells[0], cells[1]):
        begin, end = start[cell], start[cell + 1]
        if begin == end:
            continue
        candidates = later_agents(start, rows, cell)
        if rows.size > 0 and count + candidates * np.int64(end - begin) > MOST:  # cells as wide as the reach
            return CROWDED
        for i in range(begin, end):
            if count + candidates > first_agents.size:
                return CROWDED if count + candidates > MOST else -(count + candidates + 2)
            for row in range(-1, np.int64(rows.size)):
                low, high = later_in_row(start, rows, cell, i, row)
                for j in range(low, high):
                    squared_value = 0.0
                    for c in range(m):
                        gap = x[j, c] - x[i, c]
                        squared_value += gap * gap
                    first_agents[count], second_agents[count] = order[i], order[j]
                    count += squared_value < limit
    return count


@subroutine
def list_pairs(q, reach, first, second):
    """Write the pairs closer than `reach` into two arrays; return their count.

    It is CROWDED if there are too many for memory, and minus the room that is needed, or below, if that is more than
    the arrays have.
    """
    if not reach > 0.0:  # of a law without pairs: none is closer, and no cell has that size
        return 0
    order, start, rows = sort_into_grid(q, reach)
    x = np.empty(q.shape)
    for i in range(order.size):
        for c in range(q.shape[1]):
            x[i, c] = q[order[i], c]
    cells, limit = (0, start.size - 2), max(reach * reach, 5e-324)
    return list_cells(x, (order, start, rows), limit, cells, (first, second), 0)


@kernel
def covers(pairs, q, within):
    """Return whether a list still contains every pair closer than `within`.

    A motion that all share brings no two nearer, and one that stretches each coordinate by a factor brings them nearer
    by the least of these factors: the ways are seen beside it, and differ by no more than the diagonal of their box.
    Only where the first does not do is the second asked: a flock drawn together by its target.
    """
    reference, m = pairs.places, q.shape[1]
    for is_stretched in range(2 if pairs.reach[0] > 0.0 else 0):
        squared_value, nearest = 0.0, np.inf
        for c in range(0, m, 2):  # two coordinates at once: they lie side by side
            d, along_c, along_d = min(c + 1, m - 1), 1.0, 1.0
            if is_stretched:
                along_c, along_d = slope_along(reference, q, c, 1.0), slope_along(reference, q, d, 1.0)
            low_c = high_c = q[0, c] - along_c * reference[0, c]
            low_d = high_d = q[0, d] - along_d * reference[0, d]
            for i in range(1, q.shape[0]):
                way_c, way_d = q[i, c] - along_c * reference[i, c], q[i, d] - along_d * reference[i, d]
                low_c, high_c = way_c if way_c < low_c else low_c, way_c if way_c > high_c else high_c
                low_d, high_d = way_d if way_d < low_d else low_d, way_d if way_d > high_d else high_d
            squared_value += (high_c - low_c) ** 2 + ((high_d - low_d) ** 2 if d > c else 0.0)
            nearest = min(nearest, min(along_c, along_d))
        if np.sqrt(squared_value) <= nearest * pairs.reach[0] - within:
            return True
    return False


@subroutine
def noted(count, q, reach, pairs):
    """Record the agents' positions at which a pair list was made, and return its number of pairs."""
    for i in range(q.shape[0]):
        for c in range(q.shape[1]):
            pairs.places[i, c] = q[i, c]
    pairs.reach[0] = reach if count >= CROWDED else 0.0
    pairs.counts[COUNT] = count
    pairs.counts[MADE] += 1
    return count


@kernel
def listed_anew(q, reach, pairs):
    """Replace an old list by the pairs closer than `reach`; return their count, as `list_pairs` does."""
    count = list_pairs(q, reach, pairs.first, pairs.second)
    pairs.cuts[0], pairs.cuts[1], pairs.cuts[2] = 1, 0, max(count, 0)
    return noted(count, q, reach, pairs)


def no_pairs(n: int, m: int) -> Pairs:
    """Return an empty list of pairs, to be filled later."""
    first_agents, second_agents = np.empty(_ROOM * n, np.uint32), np.empty(_ROOM * n, np.uint32)
    return Pairs(first_agents, second_agents, np.empty((n, m)), np.zeros(1), empty_cuts(n), np.zeros(2, np.int64))


def with_room(pairs: Pairs) -> Pairs | None:
    """Return an empty pair list of larger capacity; None if the capacity of the last list sufficed."""
    if (missing_count := -int(pairs.counts[COUNT])) <= -CROWDED:
        return None
    capacity = max(missing_count, 2 * pairs.first.size)
    return pairs._replace(first=np.empty(capacity, np.uint32), second=np.empty(capacity, np.uint32))
