"""Rounding errors of eigenvalues, the threshold for a certain decay.

An eigenvalue λ of A with unit left and right eigenvectors y, x moves by |Δλ| ≤ ‖ΔA‖/|yᴴx| to first order, and LAPACK's
eigenvalues are those of some A + ΔA with ‖ΔA‖ a small multiple of eps ‖A‖. The linearised flock is not normal, so
1/|yᴴx| is no formality. Where m modes coalesce (critical damping: 2) they move by (‖ΔA‖/‖A‖)^(1/m) ‖A‖; as a rule they
come out as far apart as that, with eigenvectors that say so, and where they come out equal the power is taken itself.
No eigenvalue of an N x N matrix moves by more than (2 ‖A‖)^(1 − 1/N) ‖ΔA‖^(1/N) (Elsner 1985), whatever its
eigenvectors say: of a few coalesced roots that bound is the better one where rounding was kind and left them close.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from flockana.base.value_checks import ComplexArray, FloatArray
from flockana.equilibria.curvature import EPS
from flockana.stability.strong_components import strong_components

_ROUNDINGS = 16.0  # of eps ‖A‖, in the entries of A and in LAPACK
_APART = 1e-3  # from which share on the two parts of a complex eigenvector span a plane


def eigenvalues(matrix: FloatArray, off: float = 0.0) -> tuple[ComplexArray, FloatArray]:
    """Return eigenvalues with error bounds, by strongly connected components, in the order of `eigen`."""
    parts = [eigen_of_one(matrix[np.ix_(rows, rows)], off) for rows in strong_components(matrix).indices]
    values, errors = (np.concatenate([part[i] for part in parts] or [np.zeros(0)]) for i in (0, 2))
    return values.astype(np.complex128), errors


def eigen(matrix: FloatArray, off: float = 0.0) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    """Return eigenvalues, right eigenvectors, and eigenvalue error bounds from rounding and matrix errors.

    The matrix itself may be off by the share `off` of its size. A block triangular matrix has the
    eigenvalues of its strongly connected components, with the errors of these.
    """
    net = strong_components(matrix)
    if len(net) < 2:
        return eigen_of_one(matrix, off)
    vectors, column = np.zeros(matrix.shape, np.complex128), 0
    for k, rows in enumerate(net.indices):
        values, shapes, errors = eigen_of_one(matrix[np.ix_(rows, rows)], off)
        for value, shape, error in zip(values, shapes.T, errors, strict=True):
            vector = vectors[:, column]
            vector[rows] = shape
            shifted = value + max(float(error), EPS * float(np.abs(matrix).max()))  # beside an equal one of a listener
            for k_i in net.indices[k + 1 :]:
                push = matrix[k_i] @ vector
                if push.any():
                    vector[k_i] = np.linalg.solve(shifted * np.eye(k_i.size) - matrix[np.ix_(k_i, k_i)], push)
                    vector /= np.abs(vector).max()
            vector /= np.linalg.norm(vector)
            column += 1
    every, errors = eigenvalues(matrix, off)
    return every, vectors, errors


def eigen_of_one(matrix: FloatArray, off: float = 0.0) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    """Return eigenvalues, right eigenvectors and error bounds of a matrix without splitting it."""
    from scipy.linalg import eig
    from scipy.linalg.lapack import dgebal

    if not matrix.size:
        return np.zeros(0, np.complex128), np.zeros((0, 0), np.complex128), np.zeros(0)
    balanced_matrix, _, _, units, _ = dgebal(matrix, scale=1)  # by powers of 2: no rounding
    eigen_solution: Any = eig(balanced_matrix, left=True, right=True)
    values, left, right = (np.asarray(item, dtype=np.complex128) for item in eigen_solution)
    size, tight = float(np.linalg.norm(balanced_matrix)), _ROUNDINGS * EPS + off
    with np.errstate(divide="ignore"):
        value_errors = tight * size / np.abs(np.einsum("ij,ij->j", left.conj(), right))
    elsner = (2.0 * size) ** (1.0 - 1.0 / len(values)) * (tight * size) ** (1.0 / len(values))
    _take_apart(values, right, _ROUNDINGS * EPS * size)
    return values, units[:, None] * right, np.minimum(np.minimum(value_errors, elsner), _together(values, size, tight))


def _take_apart(values: ComplexArray, vectors: ComplexArray, rounding: float) -> None:
    """Replace conjugate pairs with imaginary parts within rounding by two real eigenvalues each."""
    # The two of a defective pair (critical damping) come out further apart, or share one direction: these stay a pair.
    for k in np.flatnonzero((values.imag > 0.0) & (values.imag <= rounding)).tolist():
        turned = vectors[:, k] * np.exp(-0.5j * np.angle(np.sum(vectors[:, k] ** 2)))  # real part across the imaginary
        if np.linalg.norm(turned.imag) > _APART * np.linalg.norm(turned.real):
            for j, vector in ((k, turned.real), (k + 1, turned.imag)):
                values[j], vectors[:, j] = values[k].real, vector / np.linalg.norm(vector)


def _together(values: ComplexArray, size: float, tight: float) -> FloatArray:
    """Return the error bound of each eigenvalue in a cluster of close ones; infinite for one that is alone."""
    # Of coalesced roots that came out apart the eigenvectors tell; where they came out exactly equal, yᴴx may be 0.
    from scipy.spatial import cKDTree

    plane = np.column_stack([values.real, values.imag])
    close_counts = np.asarray(cKDTree(plane).query_ball_point(plane, 2.0 * tight * size, return_length=True))
    return np.where(close_counts > 1, size * tight ** (1.0 / close_counts), np.inf)


def root_error(value: complex, stiffness: float, damping: float, errors: tuple[float, float]) -> float:
    """Return the error of a root of λ² + damping λ + stiffness, given the errors of both coefficients."""
    push, slope = errors[0] + abs(value) * errors[1], abs(2.0 * value + damping)
    double = float(np.sqrt(push))
    return min(push / slope, double) if slope > 0.0 else double


def mode_errors(stiffness: Any, damping: Any, values: ComplexArray, shapes: ComplexArray) -> FloatArray:
    """Return error bounds of roots λ of (λ² + λD + K) v = 0, from rounding and residuals; D and K symmetric."""
    # To first order by ‖(λ² + λD + K) v‖/|vᵀ(2λ + D) v|, for vᵀ is then the left eigenvector; of a double root by the
    # square root of the push.
    rows = [float(abs(matrix).sum(axis=1).max()) for matrix in (stiffness, damping)]
    errors = np.empty(len(values))
    for k, value in enumerate(values.tolist()):
        v = shapes[:, k] / np.linalg.norm(shapes[:, k])
        drag = damping @ v
        residual = float(np.linalg.norm(value * value * v + value * drag + stiffness @ v))
        push = residual + _ROUNDINGS * EPS * (rows[0] + abs(value) * rows[1] + abs(value) ** 2)
        slope = abs(complex(v @ (2.0 * value * v + drag)))
        errors[k] = min(push / slope if slope > 0.0 else np.inf, float(np.sqrt(push)))
    return errors


def slowest_first(values: ComplexArray, errors: FloatArray) -> list[int]:
    """Return the order of eigenvalues by decay rate, then frequency, equal up to rounding."""
    order: list[int] = []
    for level in _levels(range(len(values)), -np.real(values), errors):
        for pair in _levels(level, np.abs(np.imag(values)), errors):
            order += sorted(pair)
    return order


def _levels(indices: Iterable[int], sizes: FloatArray, errors: FloatArray) -> list[list[int]]:
    """Return the indices of numbers in rising order, grouped where these agree within their errors."""
    levels: list[list[int]] = []
    for k in sorted(indices, key=lambda k: float(sizes[k])):
        if levels and sizes[k] - sizes[levels[-1][-1]] <= errors[k] + errors[levels[-1][-1]]:
            levels[-1].append(k)
        else:
            levels.append([k])
    return levels
