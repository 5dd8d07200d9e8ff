"""Planar graphs: bounds on their links, tests, and a Kuratowski subgraph as witness."""

from dataclasses import dataclass
from math import isqrt
from typing import Any, Literal

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_count, ensure_links
from flockana.measures.nets import LinkArray


def harborth(n: int) -> int:
    """Return the largest number of links of a planar α-lattice of n agents, ⌊3n − √(12n − 3)⌋ (Harborth 1974).

    Examples
    --------
    >>> [harborth(n) for n in (1, 2, 3, 7, 19)]
    [0, 1, 3, 12, 42]
    """
    n = ensure_count("n", n)
    root = isqrt(12 * n - 3)  # ⌊3n − √x⌋ = 3n − ⌈√x⌉, in whole numbers
    return 3 * n - (root if root * root == 12 * n - 3 else root + 1)


def planar_bound(n: int) -> int:
    """Return the largest number of links of a planar graph, 3n − 6 from n = 3 on (erratum E6).

    Examples
    --------
    >>> [planar_bound(n) for n in (1, 2, 3, 4)]
    [0, 1, 3, 6]
    """
    n = ensure_count("n", n)
    return 3 * n - 6 if n >= 3 else n - 1


def is_complete(n: int, links: Any) -> bool:
    """Return whether all n agents are linked to each other.

    Parameters
    ----------
    links : array_like, shape (M, 2)
        Links; one that comes twice counts once.

    Examples
    --------
    >>> is_complete(3, [[0, 1], [1, 2], [0, 2]])
    True
    """
    n = ensure_count("n", n)
    return len(_distinct(n, links)) == n * (n - 1) // 2


def is_planar(n: int, links: Any) -> bool:
    """Return whether the graph of n agents is planar.

    By Euler's bound on the number of links and the left-right test of networkx.

    Parameters
    ----------
    links : array_like, shape (M, 2)

    See Also
    --------
    kuratowski : why not.

    Examples
    --------
    >>> is_planar(5, [[i, j] for i in range(5) for j in range(i)])
    False
    """
    n = ensure_count("n", n)
    return _planar(n, _distinct(n, links))


@dataclass(frozen=True, eq=False)
class Kuratowski:
    """Subdivision of K5 or K3,3: a subgraph that proves a graph not planar.

    Attributes
    ----------
    kind : {"K5", "K3,3"}
        What it is a subdivision of.
    corners : tuple of int
        Its five or six agents of degree above 2; in K3,3 the first three are linked, by paths, to the last three.
    links : int32 array, shape (K, 2)
        Its links.
    """

    kind: Literal["K5", "K3,3"]
    corners: tuple[int, ...]
    links: LinkArray


def kuratowski(n: int, links: Any) -> Kuratowski | None:
    """Return a subdivision of K5 or K3,3 in the graph; None if it is planar.

    The links are thinned out in ever smaller parts as long as what remains is not planar, so that what is left at the
    end falls apart if any one link is taken.

    Parameters
    ----------
    links : array_like, shape (M, 2)

    Examples
    --------
    >>> witness = kuratowski(6, [[i, j] for i in range(3) for j in range(3, 6)])
    >>> witness.kind, witness.corners
    ('K3,3', (0, 1, 2, 3, 4, 5))
    """
    n = ensure_count("n", n)
    remaining_links = _distinct(n, links)
    if _planar(n, remaining_links):
        return None
    batch_size = len(remaining_links)
    while batch_size >= 1:
        batch_size = min(batch_size, len(remaining_links))
        start = 0
        while start < len(remaining_links):
            fewer_links = np.delete(remaining_links, slice(start, start + batch_size), axis=0)
            if _planar(n, fewer_links):
                start += batch_size
            else:
                remaining_links = fewer_links
        batch_size //= 2
    return _name(remaining_links)


def _name(links: LinkArray) -> Kuratowski:
    import networkx

    agents, degree = np.unique(links, return_counts=True)
    corners = [int(v) for v in agents[degree > 2]]
    if len(corners) == 5:
        return Kuratowski("K5", tuple(corners), links)
    graph = networkx.Graph(links.tolist())
    paths = networkx.node_connected_component(graph.subgraph({*graph} - {*corners[1:]}), corners[0])
    corner_nodes = networkx.node_boundary(graph, paths)  # corners that paths from the first one reach
    return Kuratowski("K3,3", (*(v for v in corners if v not in corner_nodes), *sorted(corner_nodes)), links)


def _distinct(n: int, links: Any) -> LinkArray:
    return np.unique(np.sort(ensure_links(links, n), axis=1), axis=0)


def _planar(n: int, links: LinkArray) -> bool:
    """Return whether a graph is planar, by its number of links or the left-right test."""
    if len(links) < 9:  # K3,3 has nine; K5 ten
        return True
    agents = len(np.unique(links))
    if len(links) > planar_bound(agents):
        return False
    import networkx

    return networkx.check_planarity(networkx.Graph(links.tolist()))[0]


def ensure_plane(m: int) -> None:
    """Raise unless positions are in the plane."""
    if m != 2:
        raise ArgumentError(f"q has {m} columns: expected 2, as faces are those of a drawing in the plane")
