"""Agents sorted into grid cells: agents within range are in the same or adjacent cells."""

import numpy as np

from flockana.jit import inlined, kernel, subroutine

_MARGIN = 1.0 + 1e-6  # cells a little larger than the range, so that rounding never separates two that are within it
_PER_AGENT, _AT_LEAST = 8.0, 256.0  # cells at most
LARGE, _SLABS = 10_000, 64  # agents from which on sums go in slabs, and slabs at most
_ROUNDINGS = 2.0**-49  # eight of the largest coordinate: two agents, each closed up in rounds that shrink by a quarter


@inlined
def _place(x, low, width, last):
    """Return the number of the cell in which a coordinate lies; 0 for NaN."""
    cell_number = min((x - low) / width, last)
    return np.int64(cell_number) if cell_number > 0.0 else 0


@inlined
def _ends(x, k):
    low = high = x[0, k]
    for i in range(len(x)):
        low, high = min(low, x[i, k]), max(high, x[i, k])
    return low, high


@subroutine
def _closed_up(q, width, most):
    """Return a flock with gaps along each coordinate closed up; pairs within range stay so.

    Gaps are empty ones of a row of `most` bins, which are as fine as cells once the widest gaps are closed.
    """
    x, is_occupied, gap_before = q.copy(), np.empty(np.int64(most), np.bool_), np.empty(np.int64(most))
    for k in range(q.shape[1]):
        bin_width = np.inf
        while bin_width > width:
            low, high = _ends(x, k)
            bin_width = max(width, (high - low) / most)
            if not bin_width < np.inf:
                break
            is_occupied[:] = False
            for i in range(len(x)):
                is_occupied[_place(x[i, k], low, bin_width, most - 1.0)] = True
            gap_before[0] = 0.0
            for b in range(1, is_occupied.size):
                gap_before[b] = gap_before[b - 1] + (0.0 if is_occupied[b] else bin_width)
            for i in range(len(x)):
                x[i, k] -= gap_before[_place(x[i, k], low, bin_width, most - 1.0)]
    return x


@kernel
def sort_into_grid(q, side):
    """Return (order, start, rows): agents by cell, first agent of each cell, and offsets of later adjacent cell rows.

    Cells are numbered row by row, along the longest side last if the flock is large, with an empty margin around. What
    is adjacent to cell c, each two cells once, is the rest of c, cell c + 1, and of each row d in `rows` the cells
    c + d − 1 to c + d + 1. Where cells would be many more than agents, gaps are closed up; if that does not do, cells
    are strips across the longest side.
    """
    (n, m), capacity, width, x = q.shape, max(_PER_AGENT * q.shape[0], _AT_LEAST), side * _MARGIN, q
    low, cell_counts, cell_strides, total, farthest = np.empty(m), np.empty(m), np.empty(m, np.int64), np.inf, 0.0
    ranks = np.empty(m, np.int64)  # the same strides, rising
    for attempt in range(2):
        if total <= capacity:
            break
        if attempt == 1:
            width += _ROUNDINGS * farthest  # or what is closed up might round two apart by more than the margin
            x = _closed_up(q, width, capacity)
        total, last_index = 1.0, m - 1
        for k in range(m):
            low[k], high = _ends(x, k)
            farthest = max(farthest, max(abs(low[k]), abs(high)))
            cell_counts[k] = np.floor((high - low[k]) / width) + 3.0
        for k in range(m):
            last_index = k if n >= LARGE and cell_counts[k] > cell_counts[last_index] else last_index
        for rank in range(m):
            k = last_index if rank == m - 1 else (m - 1 if rank == last_index else rank)
            cell_strides[k] = ranks[rank] = np.int64(total) if total <= capacity else 0
            total *= cell_counts[k]
    strips = not total <= capacity  # of NaN too
    if strips:
        longest = 0
        for k in range(m):
            cell_strides[k] = 0
            if cell_counts[k] > cell_counts[longest]:
                longest = k
        cell_strides[longest], total = 1, capacity
    cells = np.int64(total)
    start, cell = np.empty(cells + 1, np.uint64), np.empty(n, np.int64)
    for c in range(cells + 1):
        start[c] = np.uint64(0)
    for i in range(n):
        c = 0
        for k in range(m):
            c += cell_strides[k] * (1 + _place(x[i, k], low[k], width, capacity))
        cell[i] = min(c, cells - 2)
        start[cell[i] + 1] += np.uint64(1)
    for c in range(cells):
        start[c + 1] += start[c]
    fill_positions, order = np.empty(cells, np.uint64), np.empty(n, np.uint64)
    for c in range(cells):
        fill_positions[c] = start[c]
    for i in range(n):
        order[fill_positions[cell[i]]] = i
        fill_positions[cell[i]] += np.uint64(1)
    rows = np.empty((0, 1, 4)[0 if strips else m - 1], np.uint64)
    if rows.size == 1:
        rows[0] = ranks[1]
    elif rows.size == 4:
        rows[0], rows[1], rows[2], rows[3] = ranks[1], ranks[2] - ranks[1], ranks[2], ranks[2] + ranks[1]
    return order, start, rows


@inlined
def later_in_row(start, rows, cell, i, row):
    """Return begin and end of the sorted agents after agent i in its row of cells (`row` = -1) or in a later row."""
    begin, end = i + np.uint64(1), start[cell + 2]
    if row >= 0:
        neighbour_cell = np.int64(cell) + np.int64(rows[row])
        begin, end = start[neighbour_cell - 1], start[neighbour_cell + 2]
    return begin, end


@inlined
def empty_cuts(n):
    """Return an array for the slab boundaries of n agents, set to one empty slab."""
    slab_cuts = np.empty((_SLABS if n >= LARGE else 1) + 2, np.int64)
    slab_cuts[0], slab_cuts[1], slab_cuts[2] = 1, 0, 0
    return slab_cuts


@kernel
def cut_into_slabs(start, rows, cuts):
    """Write and return the number of slabs of a grid, with the first and last cells of each.

    A slab is layers of cells across the longest side: only cells of the slab itself and of the next are adjacent to
    its own and later than they, so that all even slabs may add to both agents of their pairs at once, and all odd ones.
    """
    layer, end, slab_limit, slabs = np.int64(1), start.size - 2, cuts.size - 2, 1
    if rows.size > 0:
        layer = np.int64(rows[rows.size // 2])
    cuts[1] = 0
    for cell in range(layer, end, layer):
        agents = np.float64(start[cell] - start[cuts[slabs]])
        if slabs < slab_limit and agents * slab_limit >= np.float64(start[end]) and start[cell] < start[end]:
            slabs += 1
            cuts[slabs] = cell
    cuts[0], cuts[slabs + 1] = slabs, end
    return slabs
