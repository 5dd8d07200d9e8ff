"""First step h at which a linear map x⁺ = P(h) x grows: E(h) x⁺ = F(h) x, with E and F quadratic in h.

Up to 24 states: a multiplier is on the unit circle only where z_i z_j = 1 for some pair, hence where F X Fᵀ = E X Eᵀ
has a symmetric solution X ≠ 0. Divided by h that is a polynomial eigenproblem of degree 3. Between its real roots
stability does not change, so that one step in each interval decides; roots that belong to no multiplier on the circle
only divide intervals.

Beyond: V = (E x)ᵀ X (E x) falls for every step at which W(h) = Eᵀ X E − Fᵀ X F is positive definite. With V the sum of
the squares of the modes at one step, that holds up to the least root of det W, again a polynomial eigenproblem; there
the next V is found, until the intervals no longer grow.
"""

from itertools import pairwise
from math import inf, nan
from typing import NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray

MOST = 24  # states for which pairs of multipliers are looked at
CLOSE = 1e-6  # relative distance of the certified bound from the margin
_NEAR = 1e-2  # relative distance to which the margin must be told at least
_REAL = 1e-4  # |Im μ|/|μ| of a root that may be real: more only divide an interval once more
_INTERVALS = 60  # certified one after another
_ROUNDING = 1e-14  # of a multiplier
_WITHIN = 0.999  # of an interval that is certified


class Steps(NamedTuple):
    """Step equation E(h) x⁺ = F(h) x of a map off the neutral motions, with E and F quadratic in h."""

    e1: FloatArray
    e2: FloatArray
    f1: FloatArray
    f2: FloatArray

    def sides(self, h: float) -> tuple[FloatArray, FloatArray]:
        """Return the matrices E and F of the step equation E(h) x⁺ = F(h) x at a step h."""
        identity = np.eye(len(self.f1))
        return identity + h * (self.e1 + h * self.e2), identity + h * (self.f1 + h * self.f2)

    def multipliers(self, h: float) -> FloatArray:
        """Return the multipliers of the step map P(h): its eigenvalues at a step h."""
        return np.linalg.eigvals(np.linalg.solve(*self.sides(h)))

    def growth(self, h: float) -> float:
        """Return the largest modulus of the multipliers at a step h, minus 1."""
        return float(np.abs(self.multipliers(h)).max(initial=0.0)) - 1.0


class Growth(NamedTuple):
    """First growing step (NaN if unknown), and the largest step with a stability certificate below it."""

    period: float
    least: float


def first_growth(steps: Steps, rate: float, stable_below: float = 0.0) -> Growth:
    """Return the first step h at which the map of a stable flow grows, with its certified lower bound.

    `rate` is the size of the flow; steps up to `stable_below` are known to be stable.
    """
    if not len(steps.f1):
        return Growth(inf, inf)
    if steps.growth(1e-3 * CLOSE / rate) > _ROUNDING:
        return Growth(0.0, 0.0)
    return _by_pairs(steps, rate) if len(steps.f1) <= MOST else _by_intervals(steps, rate, stable_below)


def _by_pairs(steps: Steps, rate: float) -> Growth:
    """Return the first growing step, from the steps at which two multipliers have product 1."""
    e1, f1 = steps.e1 / rate, steps.f1 / rate
    e2, f2 = steps.e2 / rate**2, steps.f2 / rate**2
    identity = np.eye(len(f1))
    parts = [
        _on_symmetric(f1 - e1, identity),
        _on_symmetric(f2 - e2, identity) + 0.5 * (_on_symmetric(f1, f1) - _on_symmetric(e1, e1)),
        _on_symmetric(f1, f2) - _on_symmetric(e1, e2),
        0.5 * (_on_symmetric(f2, f2) - _on_symmetric(e2, e2)),
    ]
    roots = sorted(x / rate for x in _least_roots(parts))
    last_midpoint = 0.0
    for low, high in pairwise([0.0, *roots, inf]):
        trial = 2.0 * low if high == inf else 0.5 * high if low == 0.0 else float(np.sqrt(low * high))
        trial = trial or 1.0 / rate
        if steps.growth(trial) > 0.0:
            period = _refined(steps, last_midpoint, trial) if last_midpoint else low
            widths = [_resolved(steps, period, width) for width in (_NEAR, CLOSE)]
            return Growth(period if widths[0] else nan, period if widths[1] else 0.0)
        last_midpoint = trial
    return Growth(inf, inf)


def _resolved(steps: Steps, period: float, width: float) -> bool:
    """Return whether a map is stable just below a period and unstable just above it, beyond rounding."""
    return min(side * steps.growth(period * (1.0 + side * width)) for side in (-1.0, 1.0)) > 10.0 * _ROUNDING


def _on_symmetric(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the matrix of X ↦ a X bᵀ + b X aᵀ on symmetric X, in the entries X_ij, i <= j."""
    dimension = len(a)
    i, j = np.triu_indices(dimension)
    full_matrix = np.kron(a, b) + np.kron(b, a)
    columns = full_matrix[:, i * dimension + j] + np.where(i == j, 0.0, full_matrix[:, j * dimension + i])
    return columns[i * dimension + j]


def _least_roots(parts: list[FloatArray]) -> list[float]:
    """Return the positive roots x of det Σ x^k A_k = 0 in rising order, with invertible A_0."""
    dimension, degree = len(parts[0]), len(parts) - 1
    companion = np.zeros((degree * dimension, degree * dimension))
    companion[dimension:, :-dimension] = np.eye((degree - 1) * dimension)
    companion[:dimension] = -np.linalg.solve(parts[0], np.hstack(parts[1:]))
    inverse = np.linalg.eigvals(companion)
    real = (inverse.real > 0.0) & (np.abs(inverse.imag) <= _REAL * np.abs(inverse))
    return sorted((1.0 / inverse.real[real]).tolist())


def _refined(steps: Steps, stable: float, growing: float) -> float:
    """Return the step at which growth begins, located between a stable and a growing step."""
    from scipy.optimize import brentq

    return float(brentq(steps.growth, stable, growing, xtol=1e-14 * growing, rtol=1e-12))


def _by_intervals(steps: Steps, rate: float, stable_below: float) -> Growth:
    """Return the first growing step, from consecutive step intervals certified by Lyapunov functions."""
    here = _WITHIN * stable_below
    for _ in range(_INTERVALS):
        e, f = steps.sides(here)
        inverse = np.linalg.inv(np.linalg.eig(steps.f1 - steps.e1 if here == 0.0 else np.linalg.solve(e.T, f.T).T)[1])
        x = (inverse.conj().T @ inverse).real  # modes fall each at its own rate
        reach = min(_least_roots(_falls(steps, x, here, 1.0 / rate)), default=inf) / rate
        if not np.isfinite(reach):
            break
        if reach <= 0.1 * CLOSE * here:
            above = here * (1.0 + 0.5 * CLOSE)
            return Growth(_refined(steps, here, above), here) if steps.growth(above) > 0.0 else Growth(nan, here)
        here += _WITHIN * reach
        if steps.growth(here) >= 0.0:
            here -= _WITHIN * reach
            break
    return Growth(nan, here)


def _falls(steps: Steps, x: FloatArray, h: float, unit: float) -> list[FloatArray]:
    """Return the coefficients of the Lyapunov decrease W(h + unit s) by powers of s, over s at h = 0."""
    powers = []
    for first_block, second_block in ((steps.e1, steps.e2), (steps.f1, steps.f2)):
        at = np.eye(len(x)) + h * (first_block + h * second_block)
        a, b = unit * (first_block + 2.0 * h * second_block), unit * unit * second_block
        odd_part, even_part, last_part = at.T @ x @ a, at.T @ x @ b, a.T @ x @ b
        middle = a.T @ x @ a + even_part + even_part.T
        powers.append([at.T @ x @ at, odd_part + odd_part.T, middle, last_part + last_part.T, b.T @ x @ b])
    fall = [e - f for e, f in zip(*powers, strict=True)]
    return fall[1:] if h == 0.0 else fall
