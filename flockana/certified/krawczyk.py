"""Verified linear algebra on balls: Krawczyk's test for a zero, and lower bounds of eigenvalues.

Floating point only proposes, an inverse or eigenvectors; what is concluded holds whatever it proposed.
"""

from collections.abc import Callable, Sequence

import numpy as np
from flint import arb, arb_mat


def column(values: Sequence[arb]) -> arb_mat:
    """Return a vector as a matrix with one column."""
    return arb_mat(len(values), 1, list(values))


def identity(size: int) -> arb_mat:
    """Return the identity matrix."""
    return arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])


def enclose_zero(
    f: Callable[[Sequence[arb]], Sequence[arb]],
    slope: Callable[[Sequence[arb]], arb_mat],
    centre: Sequence[arb],
    radius: arb,
) -> list[arb] | None:
    """Return balls that hold the unique zero of f in a box; None if Krawczyk's test fails."""
    shift = krawczyk_shift(f, slope, centre, [radius] * len(centre))
    if not all(abs(entry) < radius for entry in shift):
        return None
    return [x + entry for x, entry in zip(centre, shift, strict=True)]


def krawczyk_shift(
    f: Callable[[Sequence[arb]], Sequence[arb]],
    slope: Callable[[Sequence[arb]], arb_mat],
    centre: Sequence[arb],
    radii: Sequence[arb],
) -> list[arb]:
    """Return K − c of Krawczyk's test on a box about c: the box has one zero if each entry is below its radius."""
    # With an enclosure S of f' on the box B and any matrix Y, let K = c - Y f(c) + (1 - Y S)(B - c). If K lies inside
    # B, then f has exactly one zero in B; it is in K, and f' is nowhere singular on B.
    offsets = [arb(0, radius) for radius in radii]
    enclosure = slope([x + offset for x, offset in zip(centre, offsets, strict=True)])
    y = enclosure.mid().inv().mid()
    return ((identity(len(offsets)) - y * enclosure) * column(offsets) - y * column(f(centre))).entries()


def least_eigenvalue(matrix: arb_mat) -> arb | None:
    """Return a positive lower bound of the eigenvalues of the matrices in the balls; None if there is none."""
    # With Q any matrix, here approximate eigenvectors, Gershgorin's discs bound the eigenvalues of QᵀAQ by some g. If g
    # > 0, Q is invertible, and ⟨Qx, A Qx⟩ >= g |x|² >= g |Qx|²/|QᵀQ|: the eigenvalues of A are at least g/|QᵀQ|.
    dimension = matrix.nrows()
    middle = np.array([[float(entry.mid()) for entry in row] for row in matrix.tolist()])
    q = arb_mat(dimension, dimension, [arb(float(x)) for x in np.linalg.eigh((middle + middle.T) / 2)[1].ravel()])
    discs = (q.transpose() * matrix * q).tolist()
    radii = (sum(map(abs, [*row[:i], *row[i + 1 :]]), arb(0)) for i, row in enumerate(discs))
    lowest_value = arb(min((row[i] - radius).lower() for i, (row, radius) in enumerate(zip(discs, radii, strict=True))))
    if not lowest_value > 0:
        return None
    row_bound = arb(max(sum(map(abs, row), arb(0)).upper() for row in (q.transpose() * q).tolist()))
    return (lowest_value / row_bound).lower()
