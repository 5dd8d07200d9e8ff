"""An embedding of a planar graph in the plane by the left-right test (de Fraysseix, Rosenstiehl; Brandes 2009).

Links are numbered; a depth-first search gives each a tail and a head, and the heights of the lowest two agents that the
search comes back to through it. Back edges that must lie on different sides of the tree are kept on a stack of pairs of
intervals; −1 is no link, and writes to it go to a spare last entry.

Nothing here needs to be believed: an embedding can be checked by counting its faces.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from flockana.jit import njit

IndexArray = npt.NDArray[np.int64]
LinkArray = npt.NDArray[np.int32]

_LL, _LH, _RL, _RH = 0, 1, 2, 3  # of a conflict pair: low and high link of its left and its right interval


@njit(cache=True)
def _orient(start, near, ends, tail, head, low, low2, nesting, height, parent):
    """Depth-first search: orientation, heights of return, and the order in which links nest."""
    n = height.size
    at, stack = start[:-1].copy(), np.empty(n, np.int64)
    for root in range(n):
        if height[root] >= 0:
            continue
        height[root] = 0
        stack[0], top = root, 0
        while top >= 0:
            v = stack[top]
            if at[v] == start[v + 1]:
                top -= 1
                continue
            k = near[at[v]]
            if tail[k] < 0:
                w = ends[k, 0] + ends[k, 1] - v
                tail[k], head[k] = v, w
                low[k] = low2[k] = height[v]
                if height[w] < 0:  # into the tree; it is met again when w is done
                    parent[w], height[w] = k, height[v] + 1
                    top += 1
                    stack[top] = w
                    continue
                low[k] = height[w]
            at[v] += 1
            if tail[k] != v:
                continue
            nesting[k] = 2 * low[k] + (low2[k] < height[v])
            e = parent[v]
            if e >= 0:
                if low[k] < low[e]:
                    low2[e], low[e] = min(low[e], low2[k]), low[k]
                elif low[k] > low[e]:
                    low2[e] = min(low2[e], low[k])
                else:
                    low2[e] = min(low2[e], low2[k])


@njit(cache=True)
def _swap(pair):
    for s in range(2):
        pair[s], pair[s + 2] = pair[s + 2], pair[s]


@njit(cache=True)
def _conflicts(high, k, low):
    return high >= 0 and low[high] > low[k]


@njit(cache=True)
def _constrain(k, e, pairs, size, bottom, low, low_edge, ref):
    """Merge what came up with link k into the constraints of e below; the new size of the stack, −1 if not planar."""
    merged = np.full(4, -1, np.int64)
    while True:
        size -= 1
        pair = pairs[size].copy()
        if pair[_LH] >= 0:
            _swap(pair)
        if pair[_LH] >= 0:
            return -1
        if low[pair[_RL]] > low[e]:
            if merged[_RH] < 0:
                merged[_RH] = pair[_RH]
            else:
                ref[merged[_RL]] = pair[_RH]
            merged[_RL] = pair[_RL]
        else:
            ref[pair[_RL]] = low_edge[e]
        if size <= bottom:
            break
    while size > 0 and (_conflicts(pairs[size - 1, _LH], k, low) or _conflicts(pairs[size - 1, _RH], k, low)):
        size -= 1
        pair = pairs[size].copy()
        if _conflicts(pair[_RH], k, low):
            _swap(pair)
        if _conflicts(pair[_RH], k, low):
            return -1
        ref[merged[_RL]] = pair[_RH]
        if pair[_RL] >= 0:
            merged[_RL] = pair[_RL]
        if merged[_LH] < 0:
            merged[_LH] = pair[_LH]
        else:
            ref[merged[_LL]] = pair[_LH]
        merged[_LL] = pair[_LL]
    if merged[_LH] >= 0 or merged[_RH] >= 0:
        pairs[size] = merged
        size += 1
    return size


@njit(cache=True)
def _lowest(pair, low):
    if pair[_LH] < 0:
        return low[pair[_RL]]
    if pair[_RH] < 0:
        return low[pair[_LL]]
    return min(low[pair[_LL]], low[pair[_RL]])


@njit(cache=True)
def _trim(e, pairs, size, tail, head, low, height, ref, side):
    """Take away the back edges that end at the tail of e; the new size of the stack."""
    u = tail[e]
    while size > 0 and _lowest(pairs[size - 1], low) == height[u]:
        size -= 1
        side[pairs[size, _LL]] = -1
    if size > 0:
        pair = pairs[size - 1]
        for own, other in ((_LL, _RL), (_RL, _LL)):
            while pair[own + 1] >= 0 and head[pair[own + 1]] == u:
                pair[own + 1] = ref[pair[own + 1]]
            if pair[own + 1] < 0 and pair[own] >= 0:
                ref[pair[own]] = pair[other]
                side[pair[own]] = -1
                pair[own] = -1
        if low[e] < height[u]:
            left, right = pair[_LH], pair[_RH]
            ref[e] = left if left >= 0 and (right < 0 or low[left] > low[right]) else right
    return size


@njit(cache=True)
def _test(start, out, tail, head, low, height, parent, ref, side):
    """Whether the back edges can be put left and right of the tree; on which side relative to `ref`."""
    n, count = height.size, out.size
    at, stack = start[:-1].copy(), np.empty(n, np.int64)
    pairs, size = np.empty((count + 1, 4), np.int64), 0
    bottom, begun, low_edge = np.zeros(count, np.int64), np.zeros(count, np.bool_), np.full(count + 1, -1, np.int64)
    for root in range(n):
        if parent[root] >= 0:
            continue
        stack[0], top = root, 0
        while top >= 0:
            v = stack[top]
            e = parent[v]
            if at[v] == start[v + 1]:
                if e >= 0:
                    size = _trim(e, pairs, size, tail, head, low, height, ref, side)
                top -= 1
                continue
            k = out[at[v]]
            if not begun[k]:
                begun[k], bottom[k] = True, size
                if parent[head[k]] == k:
                    top += 1
                    stack[top] = head[k]
                    continue
                low_edge[k] = k
                pairs[size, _LL] = pairs[size, _LH] = -1
                pairs[size, _RL] = pairs[size, _RH] = k
                size += 1
            if low[k] < height[v]:
                if at[v] == start[v]:
                    low_edge[e] = low_edge[k]
                else:
                    size = _constrain(k, e, pairs, size, bottom[k], low, low_edge, ref)
                    if size < 0:
                        return False
            at[v] += 1
    return True


@njit(cache=True)
def _resolve(ref, side):
    """Sides relative to other links become left and right."""
    chain = np.empty(side.size, np.int64)
    for k in range(side.size - 1):
        length, e = 0, k
        while ref[e] >= 0:
            chain[length] = e
            length, e = length + 1, ref[e]
        for s in range(length - 1, -1, -1):
            side[chain[s]] *= side[e]
            ref[chain[s]] = -1
            e = chain[s]


@njit(cache=True)
def _insert(after, before, h, previous):
    """Put half-link h next after another around their agent; alone if there is none."""
    if previous < 0:
        after[h] = before[h] = h
        return
    later = after[previous]
    after[previous], before[h], after[h], before[later] = h, previous, later, h


@njit(cache=True)
def _embed(start, out, head, parent, side):
    """The half-link after each around its agent: 2k at the tail of link k, 2k + 1 at its head."""
    n, count = parent.size, out.size
    after, before = np.full(2 * count, -1, np.int64), np.full(2 * count, -1, np.int64)
    for v in range(n):
        last = -1
        for s in range(start[v], start[v + 1]):
            _insert(after, before, 2 * out[s], last)
            last = 2 * out[s]
    left, right = np.full(n, -1, np.int64), np.full(n, -1, np.int64)
    at, stack = start[:-1].copy(), np.empty(n, np.int64)
    for root in range(n):
        if parent[root] >= 0:
            continue
        stack[0], top = root, 0
        while top >= 0:
            v = stack[top]
            if at[v] == start[v + 1]:
                top -= 1
                continue
            k = out[at[v]]
            at[v] += 1
            w = head[k]
            if parent[w] == k:  # around w it comes before what leaves w
                _insert(after, before, 2 * k + 1, before[2 * out[start[w]]] if start[w] < start[w + 1] else -1)
                left[v] = right[v] = 2 * k
                top += 1
                stack[top] = w
            elif side[k] > 0:
                _insert(after, before, 2 * k + 1, right[w])
            else:
                _insert(after, before, 2 * k + 1, before[left[w]])
                left[w] = 2 * k + 1
    return after


def embedding(n: int, links: LinkArray) -> tuple[IndexArray, IndexArray] | None:
    """The order of links around each agent in a drawing without crossings; None if none was found.

    Examples
    --------
    >>> owner, after = embedding(3, np.array([[0, 1], [1, 2], [0, 2]], np.int32))
    >>> bool(np.all(owner[after] == owner))
    True
    """
    ends = links.astype(np.int64)
    count = len(ends)
    near = np.argsort(ends.ravel(), kind="stable") // 2
    tail, head, parent = np.full(count, -1), np.full(count, -1), np.full(n, -1)
    low, low2, nesting, height = np.zeros(count, int), np.zeros(count, int), np.zeros(count, int), np.full(n, -1)
    _orient(_starts(n, ends.ravel()), near, ends, tail, head, low, low2, nesting, height, parent)
    out, start = np.lexsort((nesting, tail)), _starts(n, tail)
    ref, side = np.full(count + 1, -1), np.ones(count + 1, dtype=np.int64)
    if not _test(start, out, tail, head, low, height, parent, ref, side):
        return None
    _resolve(ref, side)
    out = np.lexsort((side[:count] * nesting, tail))
    return np.column_stack([tail, head]).ravel(), _embed(start, out, head, parent, side)


def _starts(n: int, agents: IndexArray) -> IndexArray:
    return np.concatenate([[0], np.cumsum(np.bincount(agents, minlength=n))])
