"""The simulation box in a dump of LAMMPS, and places of agents that were wrapped into it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from flockana.base.checks import FloatArray

AXES = "xyz"


@dataclass(frozen=True, eq=False)
class Box:
    """Edges of a box as rows, shape (3, 3), and along which it is periodic; None where the dump does not say."""

    edges: FloatArray
    periodic: tuple[bool, ...] | None

    @classmethod
    def of(cls, words: Sequence[str], rows: FloatArray) -> Self | None:
        """Return the box of an item ``BOX BOUNDS`` and its three lines; None if they are inconsistent.

        Bounds of a tilted box are those of the box around it.

        Examples
        --------
        >>> Box.of(["xy", "xz", "yz", "pp", "pp", "ss"], np.array([[0.0, 12.0, 2.0], [0, 5, 0], [0, 1, 0]])).edges[1]
        array([2., 5., 0.])
        """
        flags = [word for word in words if len(word) == 2 and set(word) <= set("pfsm")]
        periodic = tuple(flag[0] == "p" for flag in flags) if len(flags) == 3 else None
        if "abc" in words:
            return cls(rows[:, :3], periodic) if rows.shape[1] == 4 else None
        if rows.shape[1] not in (2, 3):
            return None
        xy, xz, yz = rows[:, 2] if rows.shape[1] == 3 else np.zeros(3)
        tilts = np.array([np.ptp([0.0, xy, xz, xy + xz]), np.ptp([0.0, yz]), 0.0])
        edges = np.diag(rows[:, 1] - rows[:, 0] - tilts)
        edges[1, 0], edges[2, 0], edges[2, 1] = xy, xz, yz
        return cls(edges, periodic)

    def crossed(self, axes: Sequence[int]) -> list[int]:
        """Return the periodic edges that have a component along one of some axes."""
        return [k for k in range(3) if (self.periodic is None or self.periodic[k]) and self.edges[k, list(axes)].any()]
