"""Infinitesimal rigidity: the rank of the rigidity matrix, flexes and self-stresses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import SolverError
from flockana.base.value_checks import FloatArray, ensure_links, ensure_points, ensure_positive
from flockana.base.vector_norms import scaled_near_one
from flockana.lattice.elimination import Elimination

if TYPE_CHECKING:
    from scipy.sparse import csr_array

DENSE_MAX = 800  # coordinates up to which singular values take less than a second


@dataclass(frozen=True)
class Rigidity:
    """Rank, flexes and self-stresses of a net.

    Attributes
    ----------
    rank : int
        Rank of the rigidity matrix: of n m coordinates, so many combinations are held by the links.
    rigid_motions : int
        Translations and rotations: fewer than m(m + 1)/2 where the agents stand on a point or a line.
    flexes : int
        Other infinitesimal motions that keep all lengths to first order.
    self_stresses : int
        Independent stresses of the links that leave every agent in balance.
    soft : int
        Motions, among neither of these, that stretch so little that a threshold ten times as large had counted them as
        flexes: if there are any, rank and flexes are a matter of the threshold.
    """

    rank: int
    rigid_motions: int
    flexes: int
    self_stresses: int
    soft: int

    @property
    def infinitesimally_rigid(self) -> bool:
        """Whether only translations and rotations keep all lengths to first order."""
        return self.flexes == 0


def rigidity_matrix(q: Any, links: Any) -> csr_array:
    """Return the matrix with rows (…, −u, …, u, …), u the direction of each link: velocities to length rates.

    Parameters
    ----------
    links : array_like, shape (M, 2)
        Links; one of length zero has no direction, and a row of zeros.

    Returns
    -------
    csr_array, shape (M, n m)

    Examples
    --------
    >>> rigidity_matrix([[0.0, 0.0], [3.0, 4.0]], [[0, 1]]).toarray().tolist()
    [[-0.6, -0.8, 0.6, 0.8]]
    """
    from scipy.sparse import csr_array

    q = scaled_near_one(ensure_points("q", q))[0]
    links = ensure_links(links, len(q))
    m = q.shape[1]
    step = q[links[:, 1]] - q[links[:, 0]]
    distance = np.linalg.norm(step, axis=1, keepdims=True)
    direction = np.divide(step, distance, out=np.zeros_like(step), where=distance > 0.0)
    columns = (m * links[:, :, None].astype(np.int64) + np.arange(m)).reshape(len(links), 2 * m)
    data = np.concatenate([-direction, direction], axis=1)
    starts = np.arange(len(links) + 1) * 2 * m
    return csr_array((data.ravel(), columns.ravel(), starts), shape=(len(links), q.size))


def rigidity(q: Any, links: Any, *, tol: float = 1e-5, dense: bool | None = None) -> Rigidity:
    """Return the rank of the rigidity matrix with its flexes and self-stresses.

    Small nets by singular values. Large ones by the inertia of RᵀR − (tol σ_max)² I from a sparse factorisation, which
    counts the motions that stretch less than the threshold without computing any of them; there σ_max is bounded by the
    largest column sum of RᵀR.

    Parameters
    ----------
    links : array_like, shape (M, 2)
    tol : float
        Singular values below tol times the largest count as zero. Squared in the sparse way, so not below 1e-7. The
        softest true motion of a compact patch of n agents is at about 1/√n; a strip k agents long bends at about 1/k².
    dense : bool, optional
        Force singular values (True) or the factorisation (False).

    Raises
    ------
    SolverError
        If the sparse elimination met a pivot that is zero to rounding, so that its pivots do not tell the inertia.

    Examples
    --------
    >>> square, sides = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], [[0, 1], [1, 2], [2, 3], [0, 3]]
    >>> rigidity(square, sides).flexes, rigidity(square, [*sides, [0, 2]]).infinitesimally_rigid
    (1, True)
    """
    q, tol = scaled_near_one(ensure_points("q", q))[0], ensure_positive("tol", tol)
    matrix = rigidity_matrix(q, links)
    if dense is None:
        dense = q.size <= DENSE_MAX
    rigid = rigid_motion_count(q)
    below, soft_count = _by_singular_values(matrix, tol) if dense else _by_inertia(matrix, max(tol, 1e-7), q, rigid)
    rank = q.size - below
    return Rigidity(rank, rigid, below - rigid, matrix.shape[0] - rank, soft_count)


def rigid_motion_count(q: FloatArray) -> int:
    """Return the number of independent infinitesimal translations and rotations of a configuration."""
    m = int(q.shape[1])
    sizes = np.linalg.svd(q - q.mean(axis=0), compute_uv=False)
    flat_dimensions = m - int(np.sum(sizes > 1e-9 * max(sizes[0], np.abs(q).max(initial=0.0) * 1e-6)))
    return m + m * (m - 1) // 2 - flat_dimensions * (flat_dimensions - 1) // 2


def _by_singular_values(matrix: csr_array, tol: float) -> tuple[int, int]:
    singular_values = np.linalg.svd(matrix.toarray(), compute_uv=False)
    values = np.pad(singular_values, (0, matrix.shape[1] - len(singular_values)))
    zero, wide_count = (int(np.sum(values <= factor * tol * values[0])) for factor in (1.0, 10.0))
    return zero, wide_count - zero


def _by_inertia(matrix: csr_array, tol: float, q: FloatArray, rigid: int) -> tuple[int, int]:
    gram = (matrix.T @ matrix).tocsr()
    largest = float(abs(gram).sum(axis=0).max())  # at least σ_max², on a lattice at most about twice that
    if largest == 0.0:
        return matrix.shape[1], 0
    wide_count = eigenvalues_below(gram, (10.0 * tol) ** 2 * largest, q)
    # rigid motions stretch nothing: if there is no other below the larger threshold, there is none below the smaller
    zero = rigid if wide_count == rigid else eigenvalues_below(gram, tol**2 * largest, q)
    return zero, wide_count - zero


def eigenvalues_below(gram: Any, shift: float, q: FloatArray) -> int:
    """Return the number of eigenvalues below a shift, by Sylvester's law of inertia."""
    from scipy.sparse import eye_array

    try:
        return Elimination(gram - shift * eye_array(q.size), q, keep=False).negative
    except SolverError as error:
        raise SolverError(f"{error}; use another tol, or dense=True") from None
