"""Coordination numbers, and defects of a triangular lattice: interior agents without six neighbours."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray, ensure_count, ensure_links, ensure_points
from flockana.base.vectors import scaled_near_one
from flockana.lattice.crossings import turns_left
from flockana.lattice.planarity import ensure_plane
from flockana.measures.nets import LinkArray

IntArray = npt.NDArray[np.int64]


def coordination(n: int, links: Any) -> IntArray:
    """Return the number of neighbours of each agent.

    Parameters
    ----------
    links : array_like, shape (M, 2)

    Examples
    --------
    >>> coordination(3, [[0, 1], [1, 2]]).tolist()
    [1, 2, 1]
    """
    n = ensure_count("n", n)
    return np.bincount(ensure_links(links, n).ravel(), minlength=n).astype(np.int64)


@dataclass(frozen=True, eq=False)
class Defects:
    """Coordination numbers of a planar net, with interior and rim agents separate.

    Attributes
    ----------
    coordination : int array, shape (n,)
        Number of neighbours.
    interior : bool array, shape (n,)
        Whether the agent is surrounded by triangles: each two neighbours that follow each other around it are linked.
    charge : int array, shape (n,)
        6 − coordination of interior agents (1 on a fivefold, −1 on a sevenfold defect), 0 of the others, at the rim or
        at a hole, whose number of neighbours tells nothing.
    """

    coordination: IntArray
    interior: npt.NDArray[np.bool_]
    charge: IntArray

    @property
    def counts(self) -> dict[int, int]:
        """Return the numbers of interior agents with 3, 4, 5 … neighbours."""
        sizes, numbers = np.unique(self.coordination[self.interior], return_counts=True)
        return {int(k): int(v) for k, v in zip(sizes, numbers, strict=True)}


def defects(q: Any, links: Any) -> Defects:
    """Return coordination numbers of a planar net, with interior and rim agents separate.

    Parameters
    ----------
    links : array_like, shape (M, 2)
        Links, each once; where they cross, an agent may be called interior that is in no triangulation.

    Examples
    --------
    >>> from flockana.lattice import hexagonal_patch, links
    >>> q = hexagonal_patch(2, 7.0)
    >>> defects(q, links(q, 8.4)).counts
    {6: 7}
    """
    q = ensure_points("q", q)
    ensure_plane(q.shape[1])
    links = ensure_links(links, len(q))
    count = coordination(len(q), links)
    interior = _surrounded(q, links, count)
    return Defects(count, interior, np.where(interior, 6 - count, 0))


def _surrounded(q: FloatArray, links: LinkArray, count: IntArray) -> npt.NDArray[np.bool_]:
    n = len(q)
    centre, other = np.concatenate([links, links[:, ::-1]]).T.astype(np.int64)
    near = scaled_near_one(q)[0]
    step = near[other] - near[centre]
    angle = np.arctan2(step[:, 1], step[:, 0])
    order = np.lexsort((angle, centre))
    centre, other = centre[order], other[order]
    first = np.cumsum(count) - count
    slot = np.arange(len(centre)) - first[centre]
    following = first[centre] + (slot + 1) % np.maximum(count[centre], 1)
    codes = np.sort(centre * n + other)
    sought = other * n + other[following]
    place = np.minimum(np.searchsorted(codes, sought), max(len(codes) - 1, 0))
    closed = codes[place] == sought
    closed[closed] = turns_left(q, centre[closed], other[closed], other[following][closed])
    return (np.bincount(centre[closed], minlength=n) == count) & (count >= 3)
