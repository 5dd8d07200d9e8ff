"""Consensus with a delay, x'(t) = −L x(t − τ): as a `DelaySystem`, and its roots in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np

from flockana.base.checks import FloatArray, ensure_positive
from flockana.base.errors import ArgumentError
from flockana.equilibria.curvature import EPS
from flockana.stability.delay import DelaySystem


def consensus_system(laplacian: Any) -> DelaySystem:
    """Consensus of velocities, p'(t) = −L p(t − τ), q' = p, to be given to `delay_margin` and `rightmost_roots`.

    Parameters
    ----------
    laplacian : array_like, shape (n, n)
        Symmetric L with rows that sum to 0; the multiplicity of its eigenvalue 0 is the number of components.

    Raises
    ------
    ArgumentError
        If it is not square, not symmetric, or its rows do not sum to 0.

    Examples
    --------
    >>> from flockana.stability.delay import delay_margin
    >>> margin = delay_margin(consensus_system([[1.0, -1.0], [-1.0, 1.0]]))
    >>> bool(abs(margin.delay - np.pi / 4.0) < 1e-12), bool(abs(margin.frequency - 2.0) < 1e-12)
    (True, True)
    """
    matrix = _ensure_laplacian(laplacian)
    zero, spectrum = np.zeros_like(matrix), np.linalg.eigvalsh(matrix)
    components = int(np.sum(spectrum <= len(matrix) * EPS * spectrum[-1]))
    return DelaySystem((zero, zero), (zero, matrix), neutral=len(matrix) + components)


def consensus_root(eigenvalue: float, delay: float) -> complex:
    """The rightmost root of s + λ e^(−sτ) = 0: s = W₀(−λτ)/τ, of Lambert's function.

    Parameters
    ----------
    eigenvalue : float
        λ > 0 of the Laplacian.
    delay : float
        τ > 0.

    Examples
    --------
    >>> s = consensus_root(2.0, np.pi / 4.0)
    >>> bool(abs(s - 2j) < 1e-12)
    True
    """
    from scipy.special import lambertw

    eigenvalue, delay = ensure_positive("eigenvalue", eigenvalue), ensure_positive("delay", delay)
    return complex(lambertw(-eigenvalue * delay)) / delay


def _ensure_laplacian(laplacian: Any) -> FloatArray:
    try:
        matrix = np.asarray(laplacian, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"laplacian = {laplacian!r}: expected a square array of numbers") from None
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.size or not np.isfinite(matrix).all():
        raise ArgumentError(f"laplacian has shape {matrix.shape}: expected a square array of finite numbers")
    rounding = len(matrix) * EPS * float(np.abs(matrix).max())
    if np.abs(matrix - matrix.T).max() > rounding or np.abs(matrix.sum(axis=1)).max() > rounding:
        raise ArgumentError(
            "laplacian: expected a symmetric matrix whose rows sum to 0, such as flockana.laplacian(...).toarray()"
        )
    return matrix
