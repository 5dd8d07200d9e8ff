"""Coordination numbers, and defects of a triangular lattice: interior agents without six neighbours."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray, ensure_count, ensure_links, ensure_points
from flockana.base.vector_norms import scaled_near_one
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
        degrees, agent_counts = np.unique(self.coordination[self.interior], return_counts=True)
        return {int(k): int(v) for k, v in zip(degrees, agent_counts, strict=True)}


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
    centre, neighbour = np.concatenate([links, links[:, ::-1]]).T.astype(np.int64)
    scaled_positions = scaled_near_one(q)[0]
    step = scaled_positions[neighbour] - scaled_positions[centre]
    angle = np.arctan2(step[:, 1], step[:, 0])
    order = np.lexsort((angle, centre))
    centre, neighbour = centre[order], neighbour[order]
    starts = np.cumsum(count) - count
    slot_numbers = np.arange(len(centre)) - starts[centre]
    next_positions = starts[centre] + (slot_numbers + 1) % np.maximum(count[centre], 1)
    codes = np.sort(centre * n + neighbour)
    sought_codes = neighbour * n + neighbour[next_positions]
    code_position = np.minimum(np.searchsorted(codes, sought_codes), max(len(codes) - 1, 0))
    is_closed = codes[code_position] == sought_codes
    is_closed[is_closed] = turns_left(q, centre[is_closed], neighbour[is_closed], neighbour[next_positions][is_closed])
    return (np.bincount(centre[is_closed], minlength=n) == count) & (count >= 3)
