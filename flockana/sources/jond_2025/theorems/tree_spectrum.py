"""The spectrum of the minimal model on a frozen tree at equilibrium, compared with the stated one within rounding."""

from math import nan, sqrt
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.sources.jond_2025.theorems.tree_case import TreeCase, characteristic_residual
from flockana.theorems.theorem_toolkit import EPS, FloatArray

POLYNOMIAL = 1e-6  # largest relative difference of two characteristic polynomials that counts as none
_CLEAR = 1e3  # times its rounding, from which on a number is not 0


class Spectrum(NamedTuple):
    """Zero eigenvalues, slowest decay rate, error of the polynomial, and margin against the stated spectrum."""

    zeros: int
    slowest: float
    residual: float
    margin: float
    error: float


def tree_spectrum(case: TreeCase, q: FloatArray) -> Spectrum:
    """Return the spectrum of the minimal law linearised at a tree's equilibrium, with its slowest rate."""
    # Times are counted in 1/√μ of the stiffest spring, so that nothing depends on their unit.
    return _undirected(case, q) if case.root is None else _directed(case, q)


def _directed(case: TreeCase, q: FloatArray) -> Spectrum:
    """Return the spectrum of a directed tree, from a polynomial with factors s² + a s + μ, and its kernel.

    Eigenvalues are not computed: those of a chain of equal edges are defective, and rounding would spread them.
    """
    m, unit = q.shape[1], 1.0 / sqrt(float(case.mu.max()))
    A = _in_units_of(case.edge_system(q), unit)
    springs = [(float(a) * unit, float(mu) * unit**2) for a, mu in zip(case.align, case.mu, strict=True)]
    residual = characteristic_residual(A, springs + [(a, 0.0) for a, _ in springs for _ in range(m - 1)])
    singular_values = np.linalg.svd(A, compute_uv=False)[::-1]
    zeros, kernel, rounding = _kernel(singular_values, (case.n - 1) * (m - 1))
    slowest = min(0.5 * (a - sqrt(max(a * a - 4.0 * mu, 0.0))) for a, mu in springs) / unit
    error = max(rounding, 64.0 * len(A) ** 2 * EPS / POLYNOMIAL)  # of a determinant far outside the spectrum
    return Spectrum(zeros, slowest, residual, min(1.0 - residual / POLYNOMIAL, kernel), error)


def _undirected(case: TreeCase, q: FloatArray) -> Spectrum:
    """Return the spectrum of an undirected tree, whose modes satisfy s² + γs + κ = 0 with γ, κ >= 0."""
    # All roots but 0 have negative real parts, and 0 is semisimple, if C is positive off the translations; then 0 has
    # the multiplicity of the kernel of K, less translations.
    m, unit = q.shape[1], 1.0 / sqrt(float(case.mu.max()))
    jacobian = np.asarray(case.law.jacobian(0.0, q, np.zeros_like(q)))[q.size :]
    K, C = -jacobian[:, : q.size] * unit**2, -jacobian[:, q.size :] * unit
    rigid, damping_values = np.linalg.eigvalsh(0.5 * (K + K.T)), np.linalg.eigvalsh(0.5 * (C + C.T))
    zeros, kernel, rounding = _kernel(rigid, (case.n - 1) * (m - 1) + m)
    _, neutral_count, blur = _kernel(damping_values, m)
    A = case.edge_system(q)
    moving = np.sort(np.linalg.eigvals(A).real)[: len(A) - (case.n - 1) * (m - 1)]
    skew_size = float(max(np.abs(K - K.T).max(), np.abs(C - C.T).max() / max(np.abs(C).max(), EPS)))
    return Spectrum(zeros - m, -float(moving.max()), 0.0, min(kernel, neutral_count), max(rounding, blur) + skew_size)


def _in_units_of(A: FloatArray, unit: float) -> FloatArray:
    """Return the system matrix A of (x, x') rescaled to another unit of time."""
    half_dimension = len(A) // 2
    scale = np.concatenate([np.ones(half_dimension), np.full(half_dimension, unit)])
    return A * (scale[:, None] * unit) / scale[None, :]


def _kernel(values: npt.NDArray[np.floating[Any]], expected: int) -> tuple[int, float, float]:
    """Return (number of zeros, margin, rounding) among eigenvalues expected to be zero or positive."""
    # The margin is the least of the others over the largest, negative if there are other zeros than expected, NaN if it
    # is not clear which are.
    largest = float(np.abs(values).max())
    rounding = 64.0 * len(values) * EPS
    zero, is_clear = np.abs(values) <= rounding * largest, np.abs(values) >= _CLEAR * rounding * largest
    if not (zero | is_clear).all():
        return int(zero.sum()), nan, rounding
    if int(zero.sum()) != expected or values[0] < -rounding * largest:
        return int(zero.sum()), -1.0, rounding
    return expected, float(values[expected] / largest) if expected < len(values) else 1.0, rounding
