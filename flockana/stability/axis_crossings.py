"""Least delay at which a root of a delayed flock crosses the imaginary axis, by modes or by bracketing.

s = jω is a root for the delay τ where z = e^jωτ makes z A + B singular, A = K₀ − ω² + jωD₀ and B = K₁ + jωD₁. With
z = (μ + j)/(μ − j), so that μ = cot(ωτ/2) is real on the unit circle, that is an eigenvalue problem in which nothing is
infinite where the flock without delay has no root: μ is an eigenvalue of W = −j (A + B)⁻¹(A − B).

Where all four matrices commute, or can be made triangular together, each mode has a crossing polynomial: in closed form
with at most two crossings if they are symmetric. Else frequencies are excluded a whole interval at a time: about ω the
matrix (A + B)(μ − W), in the eigenvectors of W at ω, is diagonally dominant for every real μ as long as the interval is
short against the eigenvalues' distances from the real axis. So no band is narrow enough to be missed.
"""

from collections.abc import Callable
from math import inf, nan, pi, sqrt, tan
from typing import Any, NamedTuple

import numpy as np

from flockana.base.value_checks import ComplexArray, FloatArray
from flockana.equilibria.curvature import EPS
from flockana.stability.common_blocks import ROUNDINGS, Four
from flockana.stability.eigenvalue_errors import eigen

CLOSE = 1e-6  # relative distance of the certified lower bound from the margin
MOST = 3000  # spectra: a search that needs more certifies nothing
_STEPS, _TINY = 12, 1e-14  # of Newton's method, and its last one, relative
_LOW = 1e-6  # of the largest frequency of a crossing polynomial's coefficients: what is below is a neutral motion
_DOUBLE = 1e-6  # relative: imaginary parts of roots of a crossing polynomial that touch the axis to rounding
_POWERS = 20  # of a matrix, for its Perron vector
_SOFT = 1e6  # of N eps: what is softer beside the stiffest motion is not known to a millionth
_WIDE = 2.0  # ratio of the ends of an interval that is looked at as a whole
_SAFE = 0.99  # of an interval that exact arithmetic would exclude


class Crossing(NamedTuple):
    """Delay and frequency at which a root is on the imaginary axis, and a delay below which none is."""

    delay: float
    frequency: float
    least: float


NO_CROSSING = Crossing(inf, nan, inf)


def modal_crossing(four: Four, neutral: float, lowest_frequency: float = 0.0) -> Crossing | None:
    """Return the smallest delay at which a pole reaches the imaginary axis, mode by mode; None without common modes."""
    # |k₀ − ω² + jωd₀| = |k₁ + jωd₁|: a quadratic equation in ω² where they are symmetric, else of degree 4 in ω.
    # Stiffness up to `neutral` is 0, and frequencies below the lowest are rounding of neutral motions.
    crossing = common_diagonals(four)
    if crossing is None:
        return None
    best = NO_CROSSING
    for k0, d0, k1, d1 in crossing.values.T.tolist():
        if k1 == 0.0 and d1 == 0.0:
            continue
        if crossing.real:
            total_stiffness = k0 + k1 if abs(k0 + k1) > neutral else 0.0
            magnitude = 2.0 * abs(k0) + d1 * d1 + d0 * d0
            frequencies = _frequencies(2.0 * k0 + d1 * d1 - d0 * d0, total_stiffness * (k0 - k1), magnitude)
        else:
            prompt, late_coefficients = np.array([k0, 1j * d0, -1.0]), np.array([k1, 1j * d1, 0.0])  # by powers of ω
            frequencies = _moduli_meet(prompt, late_coefficients, max(abs(d0) + abs(d1), sqrt(abs(k0) + abs(k1))))
        for omega in (omega for omega in frequencies if omega >= lowest_frequency):
            late_coefficient, prompt_coefficient = k1 + 1j * omega * d1, k0 - omega * omega + 1j * omega * d0
            delay = phase(-late_coefficient * prompt_coefficient.conjugate()) / omega
            best = min(best, Crossing(delay, omega, delay if crossing.real else (1.0 - CLOSE) * delay))
    return best


def _moduli_meet(a: ComplexArray, b: ComplexArray, size: float) -> list[float]:
    """Return the ω > 0 with |a(ω)| = |b(ω)|, polynomials by rising powers, ignoring terms far below `size`."""
    balance = np.poly1d((np.convolve(a, a.conj()).real - np.convolve(b, b.conj()).real)[::-1])
    slope, roots, meetings = balance.deriv(), balance.roots, []
    for omega in roots.real[(np.abs(roots.imag) <= _DOUBLE * np.abs(roots)) & (roots.real > _LOW * size)].tolist():
        better_frequency = omega - float(balance(omega)) / (float(slope(omega)) or inf)
        meetings.append(better_frequency if abs(better_frequency - omega) <= _DOUBLE * omega else omega)
    return meetings


class _Diagonals(NamedTuple):
    """Diagonals (4, N) of four jointly diagonalised or triangularised matrices, and whether symmetric."""

    values: Any
    real: bool


def common_diagonals(four: Four) -> _Diagonals | None:
    """Return the diagonals of four jointly diagonalised or triangularised matrices; None if impossible."""
    from scipy.linalg import schur

    magnitudes, rounding = [float(np.abs(x).max()) for x in four], ROUNDINGS * EPS * len(four[0])
    used_parts = [(x, size) for x, size in zip(four, magnitudes, strict=True) if size > 0.0]
    symmetric = all(np.abs(x - x.T).max() <= rounding * size for x, size in used_parts)
    mixed_matrix = sum((x / (size * sqrt(k + 2.0)) for k, (x, size) in enumerate(used_parts)), np.zeros_like(four[0]))
    if not symmetric and eigen(mixed_matrix)[2].max(initial=0.0) > CLOSE:
        return None
    rotation: Any = np.linalg.eigh(mixed_matrix)[1] if symmetric else schur(mixed_matrix, output="complex")[1]
    values = []
    for x, size in zip(four, magnitudes, strict=True):
        rotated_matrix = rotation.conj().T @ x @ rotation
        own_rates = np.diag(rotated_matrix)
        deviation = rotated_matrix - np.diag(own_rates) if symmetric else np.tril(rotated_matrix, -1)
        if np.abs(deviation).max(initial=0.0) > rounding * size:
            return None
        values.append(np.where(np.abs(own_rates) > rounding * size, own_rates, 0.0))
    return _Diagonals(np.array(values), symmetric)


def _frequencies(total: float, product: float, size: float) -> list[float]:
    """Return the ω > 0 with ω⁴ − total ω² + product = 0; double roots are recognised within rounding."""
    radicand = total * total - 4.0 * product
    if radicand < -ROUNDINGS * EPS * (size * size + 4.0 * abs(product)):
        return []
    far_root = 0.5 * (total + (sqrt(max(radicand, 0.0)) if total >= 0.0 else -sqrt(max(radicand, 0.0))))
    return [sqrt(x) for x in (far_root, product / far_root if far_root else 0.0) if x > 0.0]


def phase(z: complex) -> float:
    """Angle of a complex number, from 0 to 2π."""
    return float(np.angle(z)) % (2.0 * pi)


class _Spectrum(NamedTuple):
    """Eigenvalues μ of a matrix W(ω) (a real μ is an axis crossing), slopes dμ/dω, bounds of W's change.

    Row i of what is left at μ is at most √(μ² + size_i²) times the rows of `first` and `second`, whatever the sizes.
    """

    values: ComplexArray
    slopes: ComplexArray
    sizes: FloatArray
    first: FloatArray
    second: FloatArray

    def crossings(self, omega: float) -> tuple[FloatArray, FloatArray]:
        """Return frequencies at which eigenvalues of W become real, to first order, with the delays."""
        with np.errstate(divide="ignore", invalid="ignore"):
            move = -self.values.imag / self.slopes.imag
            moved_values = self.values.real + self.slopes.real * move
            delays = 2.0 * (0.5 * pi - np.arctan(moved_values)) / (omega + move)
        return omega + move, np.where(np.isfinite(delays) & (omega + move > 0.0), delays, inf)


def _spectrum(four: Four, omega: float) -> _Spectrum:
    """Return the eigenvalues of W at a frequency, with derivatives; a real one marks an axis crossing."""
    k0, d0, k1, d1 = four
    identity = np.eye(len(k0))
    inverse = np.linalg.inv(k0 + k1 - omega**2 * identity + 1j * omega * (d0 + d1))
    values, vectors = np.linalg.eig(-1j * inverse @ (k0 - k1 - omega**2 * identity + 1j * omega * (d0 - d1)))
    left = np.linalg.solve(vectors, inverse)
    mass = left @ vectors
    of_mu = 1j * (left @ (d0 + d1) @ vectors) - 2.0 * omega * mass
    alone = -(left @ (d0 - d1) @ vectors) - 2j * omega * mass
    slopes = -(values * np.diag(of_mu) + np.diag(alone))
    magnitudes = np.hypot(1.0, np.abs(values))
    first = np.hypot(np.abs(of_mu), np.abs(alone) / magnitudes[:, None])
    return _Spectrum(values, slopes, magnitudes, first, np.abs(mass) * np.hypot(1.0, 1.0 / magnitudes)[:, None])


def _distances(at: _Spectrum, lowest: float) -> FloatArray:
    """Return each eigenvalue's least |μ − μ_i|/√(μ² + size_i²) over all real μ >= `lowest`."""
    a, b, lower = at.values.real / at.sizes, at.values.imag / at.sizes, lowest / at.sizes
    total = 1.0 + a * a + b * b
    squared_value = 2.0 * b * b / (total + np.sqrt(np.maximum(total * total - 4.0 * b * b, 0.0)))
    with np.errstate(divide="ignore", invalid="ignore"):
        nearest = np.where(squared_value < 1.0, a / (1.0 - squared_value), inf)
        capped_ratios = np.minimum(np.hypot(lower - a, b) / np.hypot(1.0, lower), 1.0)
    return np.where(nearest >= lower, np.sqrt(squared_value), capped_ratios)


def _crossing_free(at: _Spectrum, angle: float) -> float:
    """Return a frequency distance within which no root crosses the axis for phases ωτ up to `angle`."""
    # Row i of the perturbed matrix is dominated by its diagonal if Σ_j (|dω| first_ij + |dω|² second_ij) s_j is less
    # than s_i times the distance of μ_i, for one set of s > 0: the Perron vector, which makes the interval longest.
    gaps = _distances(at, 1.0 / tan(0.5 * angle) if angle < 2.0 * pi else -inf)
    if not np.isfinite(at.first).all() or gaps.min() <= 0.0:
        return 0.0
    rows, scale = at.first / gaps[:, None], np.ones(len(gaps))
    for _ in range(_POWERS):
        scale = rows @ scale
        scale = np.maximum(scale / scale.max(), EPS)
    linear, quadratic_ratio = (float(np.max((x @ scale) / (gaps * scale))) for x in (at.first, at.second))
    return _SAFE * 2.0 / (linear + sqrt(linear * linear + 4.0 * quadratic_ratio))


def least_crossing(
    four: Four,
    low: float,
    high: float,
    advance: Callable[[float], object] = lambda _: None,
    best_crossing: Crossing = NO_CROSSING,
) -> Crossing:
    """Return a bracket of the least delay with a root on the axis at a frequency from `low` to `high`."""
    # The delay is one at which a root is on the axis; `least`, below which none is, is 0 if too many spectra are
    # needed, or if the softest motion is so soft that rounding may hide its crossings. `advance` is called with the
    # share of the frequencies that is done. Later crossings than the best of elsewhere are not looked for.
    todo, left = [(low, high)], MOST
    while todo:
        a, b = todo.pop()
        if b > _WIDE * a > 0.0:
            midpoint = max(sqrt(a * b), b / _WIDE)
            todo += [(a, midpoint), (midpoint, b)]  # from the top: the least delays belong to the highest frequencies
            continue
        midpoint = 0.5 * (a + b) if a > 0.0 else 0.0
        spectrum_at, left = _spectrum(four, midpoint), left - 1
        crossing_frequencies, delays = spectrum_at.crossings(midpoint)
        delays = np.where((crossing_frequencies >= a) & (crossing_frequencies <= b), delays, inf)
        if midpoint > 0.0 and delays.min() < best_crossing.least:
            crossing, step_count = _refined(four, midpoint, spectrum_at, int(delays.argmin()), best_crossing.delay)
            best_crossing, left = min(best_crossing, crossing), left - step_count
        reach = _crossing_free(spectrum_at, min(b * best_crossing.least, 2.0 * pi))
        if left <= 0 or midpoint + reach == midpoint:
            return best_crossing._replace(least=0.0)
        if a < midpoint - reach:
            todo.append((a, midpoint - reach))
        if b > midpoint + reach:
            todo.append((midpoint + reach, b))
        advance(1.0 - sum(top - bottom_end for bottom_end, top in todo) / (high - low))
    stiffnesses = np.linalg.svd(four[0] + four[2], compute_uv=False)
    is_soft = low == 0.0 and stiffnesses[-1] < _SOFT * EPS * len(stiffnesses) * stiffnesses[0]
    return best_crossing._replace(least=0.0) if is_soft else best_crossing


def _refined(four: Four, omega: float, at: _Spectrum, index: int, worst: float) -> tuple[Crossing, int]:
    """Return an axis crossing by Newton's method (infinite delay if none), and the number of spectra computed."""
    for step_number in range(_STEPS):
        value, slope = complex(at.values[index]), complex(at.slopes[index])
        frequency_step = -value.imag / slope.imag if slope.imag else inf
        if not 0.0 < omega + frequency_step < inf:
            return NO_CROSSING, step_number
        omega += frequency_step
        if abs(frequency_step) <= _TINY * omega:
            delay = phase(complex(value.real, 1.0) / complex(value.real, -1.0)) / omega
            return (Crossing(delay, omega, (1.0 - CLOSE) * delay) if delay < worst else NO_CROSSING), step_number
        at = _spectrum(four, omega)
        index = int(np.argmin(np.abs(at.values - (value + frequency_step * slope))))
    return NO_CROSSING, _STEPS
