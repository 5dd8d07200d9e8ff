"""Crossings of links, decided exactly for the positions as stored.

Two links cross if they share a point that is not the position of a common agent:

* links without a common agent cross if their closed segments meet: a proper crossing, an agent lying on another link,
  two coincident agents, a collinear overlap, all count;
* links of a common agent cross if they overlap, that is if their other ends lie on one ray from it; a link of length
  zero overlaps no link of its own agents;
* in space two links cross only if they lie in one plane.

No tolerance enters. Each sign is taken in floating point where its error bound decides it, and in whole numbers
otherwise: doubles are whole multiples of a power of two, so the determinants are exact however nearly degenerate the
links are. What rounding of the positions themselves did before is not undone: in space, where a crossing is an
equation, two links that ought to cross may miss each other by a rounding. `separation` tells by how much links miss.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_count, ensure_links, ensure_points, ensure_positive
from flockana.base.vector_norms import scaled_near_one
from flockana.jit import thawed
from flockana.kernels.link_segments import UNSURE, crossing_signs, meet, nearest_links
from flockana.measures.nets import LinkArray

LISTED = 100_000  # crossings that are listed at most where all are asked for; beyond, a count says "at least"

_FARTHEST = 1e300  # where positions differ by so many orders of magnitude that no unit fits all
_TOGETHER = 1_000_000  # pairs of links looked at in one go, about
_ROUNDINGS = 8.0  # of eps: two subtractions and a product on either side


def crossings(q: Any, links: Any, *, limit: int | None = None) -> LinkArray:
    """Return the pairs of links that cross, decided exactly in sub-quadratic time.

    Parameters
    ----------
    links : array_like, shape (M, 2)
        Pairs of different agents.
    limit : int, optional
        Stop when that many are found: a collapsed flock of n has of the order of n⁴/24.

    Returns
    -------
    int32 array, shape (K, 2)
        Indices (a, b) of links, a < b, sorted: the agents are links[a] and links[b].

    Notes
    -----
    See the module's text for what counts as crossing in degenerate cases.

    Examples
    --------
    The diagonals of a square cross; its sides do not:

    >>> q = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
    >>> crossings(q, [[0, 1], [1, 2], [0, 2], [1, 3]]).tolist()
    [[2, 3]]
    """
    q = ensure_points("q", q)
    links = ensure_links(links, len(q))
    if limit is not None:
        ensure_count("limit", limit)
    exact, x, planes = _Exact(q, links), _padded(_squarable(q)), 3 if q.shape[1] == 3 else 1
    blocks, count = [np.empty((0, 2), dtype=np.int32)], 0
    for a, b in _close_links(x, links, 0.0):
        signs = crossing_signs(x, thawed(links), a, b, planes)
        for k in np.flatnonzero(signs == UNSURE):
            signs[k] = exact.cross(int(a[k]), int(b[k]))
        blocks.append(np.column_stack([a, b])[signs == 1].astype(np.int32))
        count += len(blocks[-1])
        if limit is not None and count >= limit:
            break
    pairs = np.concatenate(blocks)
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    return pairs if limit is None else pairs[:limit]


def _padded(q: FloatArray) -> FloatArray:
    """Return positions padded with zeros to three coordinates."""
    return np.pad(q, ((0, 0), (0, 3 - q.shape[1])))


def _close_links(x: FloatArray, links: LinkArray, reach: float) -> Iterator[tuple[Any, Any]]:
    """Yield arrays (a, b), a < b, of links whose boxes, projected along the third axis, are within reach."""
    import shapely

    link_ends, slack = x[links, :2], 0.5 * reach * (1.0 + 1e-9)
    boxes = shapely.box(*(link_ends.min(axis=1) - slack).T, *(link_ends.max(axis=1) + slack).T)
    tree, begin, step = shapely.STRtree(boxes), 0, 1
    while begin < len(links):
        a, b = tree.query(boxes[begin : begin + step])
        a += begin
        begin, step = begin + step, 1 + min(2 * step, _TOGETHER * step // (a.size + 1))
        yield a[a < b], b[a < b]


def _squarable(q: FloatArray) -> FloatArray:
    """Return positions scaled by a power of two so that no difference overflows."""
    scaled_positions, _, unit = scaled_near_one(q)
    if (scaled_positions * unit == q).all():
        return scaled_positions
    if np.abs(q).max() < _FARTHEST:  # products that underflow or overflow are left to whole numbers
        return q
    raise ArgumentError(
        f"the positions reach {np.abs(q).max():.3g}, others {np.abs(q[q != 0.0]).min():.3g}: expected one unit"
    )


class _Exact:
    """Exact integer arithmetic that decides crossings of links where floating point leaves them open."""

    def __init__(self, q: FloatArray, links: LinkArray) -> None:
        self._q, self._links, self._m = q, links, q.shape[1]
        self._known: dict[int, tuple[int, ...]] = {}
        self._shift = _common_exponent(q)

    def point(self, i: int) -> tuple[int, ...]:
        """Return the position of agent i as whole numbers, padded to three coordinates."""
        if i not in self._known:
            parts = [float(v).as_integer_ratio() for v in self._q[i]]
            coordinates = [(dividend << self._shift) // divisor for dividend, divisor in parts]
            self._known[i] = tuple(coordinates + [0] * (3 - self._m))
        return self._known[i]

    def cross(self, a: int, b: int) -> bool:
        (i, j), (g, h) = ((int(v) for v in self._links[e]) for e in (a, b))
        if i in (g, h) or j in (g, h):
            shared_agent = i if i in (g, h) else j
            return _overlap(*(self.point(v) for v in (shared_agent, i + j - shared_agent, g + h - shared_agent)))
        return _meet_in_space(*(self.point(v) for v in (i, j, g, h)))


def turns_left(q: FloatArray, centre: Any, first: Any, second: Any) -> Any:
    """Return whether the turn around `centre` from agent `first` to `second` is to the left, exactly."""
    scaled_positions = _squarable(q)
    a, b = scaled_positions[first] - scaled_positions[centre], scaled_positions[second] - scaled_positions[centre]
    left, right = a[:, 0] * b[:, 1], a[:, 1] * b[:, 0]
    turns = left > right
    exact = _Exact(q, np.empty((0, 2), dtype=np.int32))
    is_open = np.abs(left - right) <= _ROUNDINGS * np.finfo(np.float64).eps * (np.abs(left) + np.abs(right))
    for k in np.flatnonzero(is_open | ~np.isfinite(left - right)):
        c, i, j = (exact.point(int(agents[k])) for agents in (centre, first, second))
        turns[k] = _turn(i, j, c, 0, 1) > 0
    return turns


def _common_exponent(q: FloatArray) -> int:
    """Return an s >= 0, nearly the least, for which all entries of 2^s q are whole numbers."""
    values = np.abs(q[q != 0.0])
    return max(0, 53 - int(np.frexp(values.min())[1])) if values.size else 0


def _turn(a: tuple[int, ...], b: tuple[int, ...], c: tuple[int, ...], s: int, t: int) -> int:
    det = (a[s] - c[s]) * (b[t] - c[t]) - (a[t] - c[t]) * (b[s] - c[s])
    return (det > 0) - (det < 0)


def _overlap(a: tuple[int, ...], b: tuple[int, ...], c: tuple[int, ...]) -> bool:
    if any(_turn(a, b, c, s, (s + 1) % 3) for s in range(3)):
        return False
    return sum((b[s] - a[s]) * (c[s] - a[s]) for s in range(3)) > 0


def _meet_in_space(a: tuple[int, ...], b: tuple[int, ...], c: tuple[int, ...], d: tuple[int, ...]) -> bool:
    """Return whether two segments in space are coplanar and cross, by their projections."""
    u, v, w = (tuple(p[s] - d[s] for s in range(3)) for p in (a, b, c))
    if sum(u[s] * (v[s - 2] * w[s - 1] - v[s - 1] * w[s - 2]) for s in range(3)):
        return False
    return all(
        meet(_turn(a, b, c, s, t), _turn(a, b, d, s, t), _turn(c, d, a, s, t), _turn(c, d, b, s, t))
        for s, t in ((0, 1), (1, 2), (2, 0))
    )


@dataclass(frozen=True)
class Separation:
    """Least distance of two links without a common agent.

    Attributes
    ----------
    distance : float
        The least distance; `reach` if no two links are nearer, 0 if two cross.
    links : (int, int) or None
        Which two; None if none is nearer than `reach`.
    """

    distance: float
    links: tuple[int, int] | None


def separation(q: Any, links: Any, *, reach: float) -> Separation:
    """Return the least distance, up to `reach`, between two links that share no agent; in floating point.

    Parameters
    ----------
    links : array_like, shape (M, 2)
        Pairs of different agents.
    reach : float
        Distance beyond which links are not compared; d is a sensible one.

    Examples
    --------
    Opposite edges of a regular tetrahedron of edge √2:

    >>> q = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]
    >>> separation(q, [[0, 1], [2, 3]], reach=2.0)
    Separation(distance=1.0, links=(0, 1))
    """
    q = ensure_points("q", q)
    links, reach = ensure_links(links, len(q)), ensure_positive("reach", reach)
    first_crossing = crossings(q, links, limit=1)
    if len(first_crossing):
        return Separation(0.0, (int(first_crossing[0, 0]), int(first_crossing[0, 1])))
    scaled_positions, (scaled_reach,), unit = scaled_near_one(q, reach)
    x, best_pair = _padded(scaled_positions), None
    for a, b in _close_links(x, links, scaled_reach):
        scaled_reach, k = nearest_links(x, thawed(links), a, b, q.shape[1] < 3, scaled_reach)
        best_pair = best_pair if k < 0 else (int(a[k]), int(b[k]))
    return Separation(scaled_reach * unit, best_pair)
