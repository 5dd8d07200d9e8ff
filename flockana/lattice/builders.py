"""Builders of α-lattices on the line, in the plane and in space, with their largest ratios r/d."""

from itertools import product
from math import isqrt, prod, sqrt
from typing import Any

import numpy as np

from flockana.base.errors import format_value
from flockana.base.value_checks import FloatArray, ensure_count, ensure_fits, ensure_known, ensure_positive

_RISE = 0.75**0.5
_STEPS = np.array([(1.0, 0.0), (0.5, _RISE), (-0.5, _RISE), (-1.0, 0.0), (-0.5, -_RISE), (0.5, -_RISE)])
_WORK = 4  # arrays of the lattice's size that are there at once while it is made
_MAX_RATIO = {
    "line": 2.0,
    "triangular": sqrt(3.0),
    "hexagonal_patch": sqrt(3.0),
    "hexagonal_spiral": sqrt(3.0),
    "square": sqrt(2.0),
    "honeycomb": sqrt(3.0),
    "simple_cubic": sqrt(2.0),
    "fcc": sqrt(2.0),
    "hcp": sqrt(2.0),
    "bcc": 2.0 / sqrt(3.0),
}


def max_ratio(name: str) -> float:
    """Return the largest κ = r/d at which a builder's pattern is an α-lattice.

    The ratio itself is allowed, as neighbours are nearer than r: `links` takes a distance that equals r up to rounding
    for r.

    Parameters
    ----------
    name : str
        The builder's name, such as ``"hexagonal_patch"`` or ``"bcc"``.

    Examples
    --------
    >>> round(max_ratio("bcc"), 4)  # below the usual 1.2
    1.1547
    """
    ensure_known("lattice", name, _MAX_RATIO)
    return _MAX_RATIO[name]


def _ensure_fits(n: int, m: int) -> None:
    """Raise before a lattice is built that does not fit into memory."""
    lattice_text = f"a lattice of {format_value(n)} agents, with what its making takes,"
    ensure_fits(lattice_text, (_WORK, n, m), "ask for fewer agents")


def _sites(basis: Any, cell: Any, counts: dict[str, int], d: float) -> FloatArray:
    """Return the sites `basis` in counts[0] × counts[1] × ... cells with edge vectors `cell`, in units of d."""
    sizes = [ensure_count(name, value) for name, value in counts.items()]
    _ensure_fits(len(basis) * prod(sizes), len(counts))
    corners = np.stack(np.meshgrid(*map(np.arange, sizes), indexing="ij"), axis=-1).reshape(-1, len(sizes))
    offsets = corners @ np.asarray(cell, dtype=float)
    sites = offsets[:, None] + np.asarray(basis, dtype=float)[None]
    return ensure_positive("d", d) * sites.reshape(-1, sites.shape[-1])


def line(n: int, d: float) -> FloatArray:
    """Return agents on a line, d apart, with n − 1 links.

    Examples
    --------
    >>> line(3, 7.0).ravel().tolist()
    [0.0, 7.0, 14.0]
    """
    return _sites([[0.0]], [[1.0]], {"n": n}, d)


def triangular(n: int, d: float) -> FloatArray:
    """Return n agents of the triangular lattice, row by row.

    Parameters
    ----------
    n : int
        Number of agents; rows hold ⌈√n⌉ of them, every second one shifted by half the spacing.

    Examples
    --------
    >>> triangular(4, 2.0)[:3].tolist()
    [[0.0, 0.0], [2.0, 0.0], [1.0, 1.7320508075688772]]
    """
    n, d = ensure_count("n", n), ensure_positive("d", d)
    _ensure_fits(n, 2)
    width = isqrt(n - 1) + 1
    row, column = np.divmod(np.arange(n), width)
    return np.column_stack([d * (column + 0.5 * (row % 2)), d * sqrt(0.75) * row])


def hexagonal_spiral(n: int, d: float) -> FloatArray:
    """Return the first n points of a spiral on the triangular lattice, with Harborth's number of links.

    Returns
    -------
    ndarray, shape (n, 2)

    Examples
    --------
    >>> from flockana.lattice import harborth, links
    >>> len(links(hexagonal_spiral(19, 7.0), 8.4)) == harborth(19)
    True
    """
    n, d = ensure_count("n", n), ensure_positive("d", d)
    _ensure_fits(n, 2)
    rings = [np.zeros((1, 2))]
    for ring in range(1, (isqrt(12 * n) + 3) // 6 + 1):  # the last ring has 3 ring (ring + 1) + 1 >= n points
        steps = np.repeat(_STEPS[[2, 3, 4, 5, 0, 1]], ring, axis=0)
        rings.append(ring * _STEPS[0] + np.cumsum(steps, axis=0))  # the first lies between two of the ring inside
    return d * np.concatenate(rings)[:n]


def hexagonal_patch(k: int, d: float) -> FloatArray:
    """Return a hexagon of the triangular lattice with k rings about its centre, 3k(k + 1) + 1 agents.

    Parameters
    ----------
    k : int
        Number of rings, >= 0.

    Returns
    -------
    ndarray, shape (3k(k + 1) + 1, 2)

    Examples
    --------
    >>> hexagonal_patch(1, 7.0).shape
    (7, 2)
    """
    k = 0 if k == 0 and not isinstance(k, bool) else ensure_count("k", k)
    return hexagonal_spiral(3 * k * (k + 1) + 1, d)


def square(rows: int, cols: int, d: float) -> FloatArray:
    """Return a rectangle of the square lattice.

    Parameters
    ----------
    rows, cols : int
        Agents along y and along x.

    Examples
    --------
    >>> square(2, 3, 7.0).shape
    (6, 2)
    """
    return _sites([[0.0, 0.0]], [[0.0, 1.0], [1.0, 0.0]], {"rows": rows, "cols": cols}, d)


def honeycomb(rows: int, cols: int, d: float) -> FloatArray:
    """Return a parallelogram of the honeycomb: rows × cols cells of two agents.

    Parameters
    ----------
    rows, cols : int
        Cells along either edge.

    Examples
    --------
    >>> honeycomb(2, 3, 7.0).shape
    (12, 2)
    """
    h = sqrt(0.75)
    return _sites([[0.0, 0.0], [h, 0.5]], [[h, 1.5], [2.0 * h, 0.0]], {"rows": rows, "cols": cols}, d)


def simple_cubic(nx: int, ny: int, nz: int, d: float) -> FloatArray:
    """Return a block of the simple cubic lattice.

    Parameters
    ----------
    nx, ny, nz : int
        Agents along each axis.

    Examples
    --------
    >>> simple_cubic(2, 2, 2, 7.0).shape
    (8, 3)
    """
    return _sites([[0.0, 0.0, 0.0]], np.eye(3), {"nx": nx, "ny": ny, "nz": nz}, d)


def fcc(nx: int, ny: int, nz: int, d: float) -> FloatArray:
    """Return a block of the face-centred cubic lattice: cubes of side √2 d with four agents each.

    Parameters
    ----------
    nx, ny, nz : int
        Cubes along each axis.

    Examples
    --------
    >>> fcc(2, 2, 2, 7.0).shape
    (32, 3)
    """
    side = sqrt(2.0)
    basis = 0.5 * side * np.array([[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]])
    return _sites(basis, side * np.eye(3), {"nx": nx, "ny": ny, "nz": nz}, d)


def hcp(nx: int, ny: int, nz: int, d: float) -> FloatArray:
    """Return a block of the hexagonal close packing: cells d × √3 d × √(8/3) d with four agents each.

    Parameters
    ----------
    nx, ny, nz : int
        Cells along each axis.

    Examples
    --------
    >>> hcp(2, 2, 2, 7.0).shape
    (32, 3)
    """
    w, c = sqrt(3.0), sqrt(8.0 / 3.0)
    basis = [[0.0, 0.0, 0.0], [0.5, w / 2.0, 0.0], [0.5, w / 6.0, c / 2.0], [0.0, 2.0 * w / 3.0, c / 2.0]]
    return _sites(basis, np.diag([1.0, w, c]), {"nx": nx, "ny": ny, "nz": nz}, d)


def bcc(nx: int, ny: int, nz: int, d: float) -> FloatArray:
    """Return a block of the body-centred cubic lattice: cubes of side 2d/√3 with two agents each.

    Parameters
    ----------
    nx, ny, nz : int
        Cubes along each axis.

    Examples
    --------
    >>> bcc(2, 2, 2, 7.0).shape
    (16, 3)
    """
    side = 2.0 / sqrt(3.0)
    return _sites([[0.0] * 3, [0.5 * side] * 3], side * np.eye(3), {"nx": nx, "ny": ny, "nz": nz}, d)


def fcc_star(d: float) -> FloatArray:
    """Return a site of the face-centred cubic lattice and its twelve neighbours, shape (13, 3)."""
    steps = (x for x in product((-1, 0, 1), repeat=3) if x[0] ** 2 + x[1] ** 2 + x[2] ** 2 == 2)
    return d / sqrt(2.0) * np.array([(0, 0, 0), *steps], dtype=float)
