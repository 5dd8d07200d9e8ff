"""Candidates of crossing links, and distances of links, by a cell grid over links.

Long links are cut into pieces, so that one of them costs no more cells than its length; every two pieces are compared
in one cell, the lowest that both reach.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.jit import kernel, thawed
from flockana.kernels.segments import between, cross, foot

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.int32]
BoolArray = npt.NDArray[np.bool_]

BLOCK = 8192  # pairs of links in a block
_CLAMP = 2.0**40  # farthest cell: links beyond it share one, which is slow and still right
_LONGEST = 4.0  # a piece's length at most, in mean lengths: at most M/4 pieces more than links


class Grid(NamedTuple):
    """Pieces of links and the cells that they reach; entries are sorted by bucket."""

    x: FloatArray  # (n, 3): positions, padded with zeros
    pairs: IndexArray  # (M, 2): links
    owner: IndexArray  # (P,): the link of each piece
    low: FloatArray  # (P, 3): box of each piece
    high: FloatArray
    home: npt.NDArray[np.int64]  # (P, 3): lowest cell of each piece
    piece: npt.NDArray[np.int64]  # (E,): piece of each entry
    stop: npt.NDArray[np.int64]  # (E,): end of its bucket
    cell: npt.NDArray[np.int64]  # (E, 3): its cell


@kernel
def _bucket(c0, c1, c2, size):
    return (c0 * 73856093 + c1 * 19349663 + c2 * 83492791) & (size - 1)


@kernel
def _enter(home, last, size):
    """Counting sort of (piece, cell) by bucket."""
    start = np.zeros(size + 1, np.int64)
    for fill in range(2):
        if fill == 1:
            for b in range(size):
                start[b + 1] += start[b]
            total = start[size]
            piece, cell, stop = np.empty(total, np.int64), np.empty((total, 3), np.int64), np.empty(total, np.int64)
            slot = start[:-1].copy()
        for p in range(home.shape[0]):
            for c0 in range(home[p, 0], last[p, 0] + 1):
                for c1 in range(home[p, 1], last[p, 1] + 1):
                    for c2 in range(home[p, 2], last[p, 2] + 1):
                        b = _bucket(c0, c1, c2, size)
                        if fill == 0:
                            start[b + 1] += 1
                            continue
                        e = slot[b]
                        slot[b] += 1
                        piece[e], stop[e] = p, start[b + 1]
                        cell[e, 0], cell[e, 1], cell[e, 2] = c0, c1, c2
    return piece, stop, cell


@kernel
def _compared(owner, low, high, home, piece, cell, s, t):
    """Whether two entries are pieces of two links with overlapping boxes, in the one cell where they are compared."""
    p, o = piece[s], piece[t]
    if owner[p] == owner[o]:
        return False
    for k in range(3):
        if low[p, k] > high[o, k] or low[o, k] > high[p, k]:
            return False
        common = max(home[p, k], home[o, k])
        if cell[s, k] != common or cell[t, k] != common:
            return False
    return True


@kernel
def _fill(links, planes, row, first, second, sure):
    """Fill the block from entry `row` on; a row that does not fit whole is left for the next block."""
    x, pairs, owner, low, high, home, piece, stop, cell = links
    count, capacity = 0, first.size
    for s in range(row, piece.size):
        mark = count
        for t in range(s + 1, stop[s]):
            if not _compared(owner, low, high, home, piece, cell, s, t):
                continue
            a, b = owner[piece[s]], owner[piece[t]]
            sign = cross(x, pairs[a, 0], pairs[a, 1], pairs[b, 0], pairs[b, 1], planes)
            if sign == 0:
                continue
            if count == capacity:
                return s, mark
            first[count], second[count], sure[count] = a, b, sign == 1
            count += 1
    return piece.size, count


@kernel
def _nearest(links, planar, reach):
    x, pairs, owner, low, high, home, piece, stop, cell = links
    best, first, second = reach, -1, -1
    for s in range(piece.size):
        for t in range(s + 1, stop[s]):
            if not _compared(owner, low, high, home, piece, cell, s, t):
                continue
            a, b = owner[piece[s]], owner[piece[t]]
            i, j, g, h = pairs[a, 0], pairs[a, 1], pairs[b, 0], pairs[b, 1]
            if i in (g, h) or j in (g, h):
                continue
            if planar:  # links that do not cross are nearest at an end of one of them
                far = min(foot(x[i], x[g], x[h]), foot(x[j], x[g], x[h]))
                here = min(far, foot(x[g], x[i], x[j]), foot(x[h], x[i], x[j]))
            else:
                here = between(x[i], x[j], x[g], x[h])
            if here < best:
                best, first, second = here, a, b
    return best, first, second


def grid(q: FloatArray, pairs: IndexArray, *, reach: float = 0.0) -> Grid:
    """Sort links into cells so that any two that come within `reach` share one.

    Examples
    --------
    >>> len(grid(np.array([[0.0], [9.0]]), np.array([[0, 1]], np.int32)).owner)
    1
    """
    x = np.zeros((len(q), 3))
    x[:, : q.shape[1]] = q
    start, step = x[pairs[:, 0]], x[pairs[:, 1]] - x[pairs[:, 0]]
    length = np.abs(step).max(axis=1, initial=0.0)
    longest = float(length.max(initial=0.0))
    side = max(min(longest, _LONGEST * float(length.mean())) if longest > 0.0 else 0.0, reach)
    side = side if side > 0.0 else 1.0
    parts = np.maximum(1, np.ceil(length / side)).astype(np.int64)
    owner = np.repeat(np.arange(len(pairs), dtype=np.int32), parts)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    cut = parts[owner][:, None]
    begin = start[owner] + step[owner] * (number[:, None] / cut)
    end = start[owner] + step[owner] * ((number[:, None] + 1) / cut)
    whole = cut[:, 0] == 1
    end[whole] = x[pairs[owner[whole], 1]]  # exact, so that boxes of uncut links are
    ends = np.abs(x[pairs]).max(axis=(1, 2), initial=0.0)
    slack = 0.5 * reach * (1.0 + 1e-9) + np.where(whole, 0.0, 8.0 * 2.0**-53 * ends[owner])
    low, high = np.minimum(begin, end) - slack[:, None], np.maximum(begin, end) + slack[:, None]
    home, last = (np.floor(np.clip(v / side, -_CLAMP, _CLAMP)).astype(np.int64) for v in (low, high))
    piece, stop, cell = _enter(home, last, 1 << int(2 * len(owner)).bit_length())
    links = thawed(np.ascontiguousarray(pairs, dtype=np.int32))
    return Grid(x, links, owner, low, high, home, piece, stop, cell)


def crossing_blocks(q: FloatArray, pairs: IndexArray) -> Iterator[tuple[IndexArray, IndexArray, BoolArray]]:
    """Yield blocks (a, b, sure) of links a, b that cross, or may cross where not sure; reused from block to block.

    Links that were cut may come more than once.

    Examples
    --------
    >>> q = np.array([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]])
    >>> [(a.tolist(), b.tolist(), s.tolist()) for a, b, s in crossing_blocks(q, np.array([[0, 1], [2, 3]], np.int32))]
    [([0], [1], [True])]
    """
    parts = grid(q, pairs)
    planes = 3 if q.shape[1] == 3 else 1
    entries = parts.piece.size
    capacity = max(BLOCK, int((parts.stop - np.arange(entries)).max(initial=0)))
    first, second, sure = np.empty(capacity, np.int32), np.empty(capacity, np.int32), np.empty(capacity, np.bool_)
    row = 0
    while row < entries:
        row, count = _fill(parts, planes, row, first, second, sure)
        yield first[:count], second[:count], sure[:count]


def nearest_links(q: FloatArray, pairs: IndexArray, reach: float) -> tuple[float, int, int]:
    """Least distance of two links without a common agent, and which; (reach, −1, −1) if none is nearer than `reach`.

    Examples
    --------
    >>> q = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.5], [1.0, 0.5]])
    >>> nearest_links(q, np.array([[0, 1], [2, 3]], np.int32), 1.0)
    (0.5, 0, 1)
    """
    best, first, second = _nearest(grid(q, pairs, reach=reach), q.shape[1] < 3, reach)
    return float(best), int(first), int(second)
