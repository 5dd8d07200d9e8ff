"""Strongly connected components of a net: agents that hear each other, directly or through others.

Ordered so that each component hears earlier ones only, the matrices of a linear flock are block triangular: its poles
are those of its components, each taken by itself. A chain of n equal followers has one pole n times, in a Jordan block
that moves by (rounding)^(1/n) where the whole matrix is given to LAPACK, and by rounding where its blocks are.
"""

from dataclasses import dataclass
from functools import cached_property
from graphlib import TopologicalSorter
from typing import Any

import numpy as np
import numpy.typing as npt

IndexArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class StrongComponents:
    """Indices of each strongly connected component, heard components before hearing ones."""

    indices: tuple[IndexArray, ...]  # rows of each component, rising
    heard: tuple[frozenset[int], ...]  # numbers of the earlier components that each hears directly

    def __len__(self) -> int:
        return len(self.indices)

    def downstream(self, k: int) -> IndexArray:
        """Return the rows of all components that hear component k, directly or through others, in order."""
        parts = [self.indices[j] for j, sources in enumerate(self._all_heard) if k in sources]
        return np.concatenate(parts) if parts else np.zeros(0, dtype=np.int64)

    @cached_property
    def _all_heard(self) -> tuple[frozenset[int], ...]:
        subsets: list[frozenset[int]] = []
        for heard_group in self.heard:
            subsets.append(heard_group.union(*(subsets[j] for j in heard_group)))
        return tuple(subsets)


def strong_components(*matrices: Any) -> StrongComponents:
    """Return the strongly connected components of the union of square matrices.

    Entry (i, j) says what i hears from j; only an exact zero is none.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    links = sum((abs(csr_array(matrix)) for matrix in matrices[1:]), abs(csr_array(matrices[0]))).tocoo()
    links.eliminate_zeros()
    count, label = connected_components(links, directed=True, connection="strong")
    heard_groups: dict[int, set[int]] = {k: set() for k in range(count)}
    for k, edge_source in np.unique(np.stack([label[index] for index in links.coords]), axis=1).T.tolist():
        if k != edge_source:
            heard_groups[k].add(edge_source)
    order = list(TopologicalSorter(heard_groups).static_order())
    group_number = {k: number for number, k in enumerate(order)}
    rows, group_ends = np.argsort(label, kind="stable"), np.cumsum(np.bincount(label, minlength=count))[:-1]
    members = np.split(rows, group_ends)
    return StrongComponents(
        tuple(members[k] for k in order), tuple(frozenset(group_number[j] for j in heard_groups[k]) for k in order)
    )
