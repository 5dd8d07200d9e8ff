"""Consensus with a delay, x'(t) = −L x(t − τ): as a `DelaySystem`, and its roots in closed form."""

from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_fits, ensure_positive
from flockana.equilibria.curvature import EPS
from flockana.stability.delay import DelaySystem


def consensus_system(laplacian: Any) -> DelaySystem:
    """Return the consensus of velocities, p'(t) = −L p(t − τ), q' = p, as a `DelaySystem`.

    Parameters
    ----------
    laplacian : array_like or sparse array, shape (n, n)
        L with rows that sum to 0, symmetric or not (row i: what agent i hears), such as networkx's. The multiplicity of
        its eigenvalue 0 is the number of groups that hear nobody outside.

    Raises
    ------
    ArgumentError
        If it is not square, or its rows do not sum to 0.

    Examples
    --------
    >>> from flockana.stability.delay import delay_margin
    >>> margin = delay_margin(consensus_system([[1.0, -1.0], [-1.0, 1.0]]))
    >>> bool(abs(margin.delay - np.pi / 4.0) < 1e-12), bool(abs(margin.frequency - 2.0) < 1e-12)
    (True, True)

    A directed cycle of three bears min (π/2 − |arg λ|)/|λ| over the eigenvalues λ of L:

    >>> cycle = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0]]
    >>> round(delay_margin(consensus_system(cycle)).delay, 4)
    0.6046
    """
    matrix = _ensure_laplacian(laplacian)
    zero = np.zeros_like(matrix)
    return DelaySystem((zero, zero), (zero, matrix), neutral=len(matrix) + _closed_groups(matrix))


def _closed_groups(matrix: FloatArray) -> int:
    """Return the number of strongly connected groups of agents that hear no agent outside the group."""
    import networkx

    heard_graph = networkx.from_numpy_array(matrix - np.diag(np.diag(matrix)), create_using=networkx.DiGraph)
    return int(networkx.number_attracting_components(heard_graph))


def consensus_root(eigenvalue: float, delay: float) -> complex:
    """Return the rightmost root of s + λ e^(−sτ) = 0: s = W₀(−λτ)/τ, by Lambert's function.

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
    product = eigenvalue * delay  # at 1/e two roots meet, and scipy returns NaN
    return complex(-1.0 if product == np.exp(-1.0) else lambertw(-product)) / delay


def _ensure_laplacian(laplacian: Any) -> FloatArray:
    if hasattr(laplacian, "toarray"):  # scipy's sparse arrays and matrices
        ensure_fits("the Laplacian", np.shape(laplacian), "take fewer agents")
        laplacian = laplacian.toarray()
    try:
        matrix = np.asarray(laplacian, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"laplacian = {laplacian!r}: expected a square array of numbers") from None
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.size or not np.isfinite(matrix).all():
        raise ArgumentError(f"laplacian has shape {matrix.shape}: expected a square array of finite numbers")
    rounding = len(matrix) * EPS * float(np.abs(matrix).max())
    if np.abs(matrix.sum(axis=1)).max() > rounding:
        raise ArgumentError(
            f"laplacian: row {int(np.abs(matrix.sum(axis=1)).argmax())} sums to "
            f"{np.abs(matrix.sum(axis=1)).max():.3g}: expected rows that sum to 0, such as flockana.laplacian(...)"
        )
    return matrix
