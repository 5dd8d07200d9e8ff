"""Delayed interactions: the linear flock with its delayed part, and its delay margin.

x''(t) = −K₀ x(t) − D₀ x'(t) − K₁ x(t − τ) − D₁ x'(t − τ): all that an agent hears is τ old, and so is its own state
("all": K₀ = D₀ = 0); or what depends on differences from other agents, its own state in them included ("pairs": the
γ-terms, drag and obstacles act at once); or only what it hears of other agents ("neighbours": it knows its own state at
once, so that the blocks of an agent with itself are prompt).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, nan
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.progress import progress_bar
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import (
    ComplexArray,
    FloatArray,
    ensure_affordable,
    ensure_fits,
    ensure_kind,
    ensure_known,
    ensure_nonnegative,
    ensure_numbers,
)
from flockana.stability.axis_crossings import (
    CLOSE,
    NO_CROSSING,
    Crossing,
    common_diagonals,
    least_crossing,
    modal_crossing,
)
from flockana.stability.common_blocks import Four, split_into_blocks
from flockana.stability.cost_estimates import LIMIT
from flockana.stability.eigenvalue_errors import eigenvalues
from flockana.stability.linear_flock import LinearFlock
from flockana.stability.strong_components import strong_components
from flockana.stability.zero_modes import NEUTRAL, ZERO, kernel_of

DELAYED = ("all", "pairs", "neighbours")
CARRIES = ("both", "positions", "velocities")
_GENERIC = 0.7310585786  # a delay, in units of D over K₁, at which by chance nothing cancels
_BRIEF = 1e-4  # a delay, in the same unit: as short as matters
_SECONDS, _SECONDS_OF_SPECTRUM = 2e-9, 6e-9  # per cubed size: of all modes, of one spectrum of the search
_SPECTRA = 60  # that a search needs, as a rule
_LOWEST = 1e-6  # of the highest frequency at which roots can cross: with neutral motions the search begins there


@dataclass(frozen=True)
class DelaySystem(ShortRepr):
    """Linear flock x'' = −K₀ x − D₀ x' − K₁ x(t−τ) − D₁ x'(t−τ) with one free delay.

    Parameters
    ----------
    prompt, late : (ndarray, ndarray), shapes (N, N)
        (K₀, D₀) and (K₁, D₁).
    neutral : int
        Roots at s = 0, whatever the delay: of motions that nothing brings back.

    Examples
    --------
    >>> drag = DelaySystem((np.zeros((1, 1)), np.zeros((1, 1))), (np.zeros((1, 1)), np.eye(1)), neutral=1)
    >>> bool(abs(drag.characteristic(1j, np.pi / 2.0)[0, 0]) < 1e-12)
    True
    """

    prompt: tuple[FloatArray, FloatArray]
    late: tuple[FloatArray, FloatArray]
    neutral: int = 0

    def __post_init__(self) -> None:
        shape = "(K₀, D₀) and (K₁, D₁), square matrices of one size"
        four = [ensure_numbers(name, item, shape) for name in ("prompt", "late") for item in getattr(self, name)]
        shapes = {item.shape for item in four}
        if len(four) != 4 or len(shapes) > 1 or four[0].ndim != 2 or len(set(four[0].shape)) > 1:
            raise ArgumentError(f"matrices of shapes {', '.join(str(item.shape) for item in four)}: expected {shape}")
        if not all(np.isfinite(item).all() for item in four):
            raise ArgumentError(f"a matrix has a number that is not finite: expected {shape}")

    @property
    def highest(self) -> float:
        """Return a frequency above which no characteristic root crosses the imaginary axis."""
        k, d = (sum(float(np.linalg.norm(part[i], 2)) for part in (self.prompt, self.late)) for i in (0, 1))
        return 0.5 * (d + float(np.hypot(d, 2.0 * np.sqrt(k))))

    def characteristic(self, s: complex, delay: float) -> ComplexArray:
        """Return s² + K₀ + s D₀ + (K₁ + s D₁) e^(−sτ), singular at the roots.

        Parameters
        ----------
        s : complex
            Per time unit.
        delay : float
            τ.
        """
        (k0, d0), (k1, d1) = self.prompt, self.late
        return s * s * np.eye(len(k0)) + k0 + s * d0 + (k1 + s * d1) * np.exp(-s * delay)

    def strong_parts(self) -> Iterator[DelaySystem]:
        """Return the delay systems of the strongly connected components, which together have all roots."""
        matrices, parts = (*self.prompt, *self.late), []
        for rows in strong_components(*matrices).indices:
            k0, d0, k1, d1 = (part[np.ix_(rows, rows)] for part in matrices)
            kernel, cokernel = kernels(k0 + k1) if self.neutral else (np.zeros((len(rows), 0)),) * 2
            parts.append(DelaySystem((k0, d0), (k1, d1), neutral_roots(kernel, cokernel, d0 + d1, k1)))
        if sum(part.neutral for part in parts) == self.neutral:
            return iter(parts)
        return (
            replace(part, neutral=self.neutral) for part in parts
        )  # softer than rounding tells: any part may have them


@dataclass(frozen=True)
class DelayMargin:
    """Delay at which stability is lost.

    Parameters
    ----------
    delay : float
        τ*; infinite if no delay does it, 0 if the flock is not stable without one, by more than rounding.
    frequency : float
        Of the oscillation that then neither grows nor decays, in radians per time unit; NaN where there is none.
    least : float
        Certified lower bound: no shorter delay brings a root onto the axis. By default the delay itself.
    """

    delay: float
    frequency: float
    least: float = nan

    def __post_init__(self) -> None:
        if np.isnan(self.least):
            object.__setattr__(self, "least", self.delay)

    @property
    def certified(self) -> bool:
        """Whether the delay found equals the margin to a millionth; otherwise the margin is at most this delay."""
        return self.least >= (1.0 - 2.0 * CLOSE) * self.delay


def delayed_flock(flock: LinearFlock, delayed: str, carries: str, links: Any = None) -> DelaySystem:
    """Return a linear flock whose interactions are delayed: see `delay_system`."""
    ensure_known("set of delayed terms", delayed, DELAYED)
    ensure_known("quantity that is late", carries, CARRIES)
    ensure_fits("K", flock.stiffness.shape, "ask of fewer agents")
    k, d = flock.stiffness.toarray(), flock.damping.toarray()
    late_k, late_d = (late_part(matrix, flock.q.shape[1], delayed, links) for matrix in (k, d))
    late_k, late_d = late_k * (carries != "velocities"), late_d * (carries != "positions")
    zero = flock.second_order.invariant
    neutral_count = neutral_roots(zero.kernel, zero.cokernel, d, late_k)
    return DelaySystem((k - late_k, d - late_d), (late_k, late_d), neutral_count)


def late_part(matrix: FloatArray, m: int, delayed: str, links: Any = None) -> FloatArray:
    """Return the delayed part of a stiffness or damping matrix K or D, shape (n m, n m)."""
    n = len(matrix) // m
    if links is None and delayed == "all":
        return matrix
    is_neighbour = ~np.eye(n, dtype=bool)
    if links is not None:
        if delayed == "all":
            raise ArgumentError('links: expected delayed="pairs" or "neighbours", of which single links may be late')
        i, j = ensure_directed_links(links, n).T
        is_neighbour = np.zeros((n, n), dtype=bool)
        is_neighbour[i, j] = True
    neighbour_matrix = np.where(np.kron(is_neighbour, np.ones((m, m), dtype=bool)), matrix, 0.0)
    if delayed == "neighbours":
        return neighbour_matrix
    # what depends on differences alone gives the rows of blocks that sum to 0
    own_part = -neighbour_matrix.reshape(n, m, n, m).sum(axis=2)
    for i in range(n):
        neighbour_matrix[i * m : (i + 1) * m, i * m : (i + 1) * m] = own_part[i]
    return neighbour_matrix


def ensure_directed_links(links: Any, n: int) -> Any:
    """Return directed links (i, j), i hears j, as an int array (M, 2); raise on invalid pairs."""
    pairs = np.asarray(links)
    if pairs.ndim != 2 or pairs.shape[1] != 2 or pairs.dtype.kind not in "iu":
        raise ArgumentError(f"links = {format_value(links)}: expected pairs (i, j) of agents, i hears j")
    if (pairs < 0).any() or (pairs >= n).any() or (pairs[:, 0] == pairs[:, 1]).any():
        raise ArgumentError(f"links = {format_value(links)}: expected pairs of two different agents from 0 to {n - 1}")
    return pairs


def neutral_roots(kernel: FloatArray, cokernel: FloatArray, damping: FloatArray, late: FloatArray) -> int:
    """Return the number of characteristic roots at 0 for almost every delay.

    On the kernel of K the characteristic matrix begins with s (D − τK₁): where a part of it is 0 as well, a velocity
    persists, and the root is double.
    """
    count = kernel.shape[1]
    if not count:
        return 0
    parts = [(cokernel.T @ x @ kernel) / (float(np.abs(x).max()) or 1.0) for x in (damping, late)]
    rank = int(np.sum(np.linalg.svd(parts[0] - _GENERIC * parts[1], compute_uv=False) > ZERO))
    return 2 * count - rank


def scalar_margin(k: float, d: float) -> DelayMargin:
    """Return the delay margin of the scalar equation x'' = −k x(t−τ) − d x'(t−τ) in closed form.

    On the axis k + jωd = ω² e^jωτ: ω² = (d² + √(d⁴ + 4k²))/2 and τ = atan2(ωd, k)/ω.

    Parameters
    ----------
    k, d : float
        Stiffness and damping, both >= 0.

    Examples
    --------
    >>> round(scalar_margin(0.0, 2.0).delay / np.pi, 12)
    0.25
    """
    k, d = ensure_nonnegative("k", k), ensure_nonnegative("d", d)
    if k == 0.0 and d == 0.0:
        return DelayMargin(inf, float("nan"))
    unit = max(d, float(np.sqrt(k)))  # nothing overflows
    k, d = k / unit / unit, d / unit
    omega = float(np.sqrt(0.5 * (d * d + np.hypot(d * d, 2.0 * k))))
    return DelayMargin(float(np.arctan2(omega * d, k)) / omega / unit, omega * unit)


def delay_margin(system: DelaySystem, *, progress: bool = False, limit: float = LIMIT) -> DelayMargin:
    """Return the least delay at which a root reaches the imaginary axis.

    In closed form or by a polynomial for each mode where prompt and late parts share their modes, symmetric or not;
    else by a search over all frequencies that excludes whole intervals by a bound
    (`flockana.stability.axis_crossings`): no band is too narrow for it. A symmetric lattice is searched block by block,
    one for each type of motion (`flockana.stability.common_blocks`). Parts that hear others and are not heard by
    them are looked at by themselves. Neutral motions are set apart; a flock that has any is searched from a millionth
    of its highest frequency on. Nothing is certified (`least` is 0) where the softest motion is so much softer than the
    stiffest that rounding may hide its crossings.

    Parameters
    ----------
    system : DelaySystem
        Stable without delay, but for neutral motions.
    limit : float
        Seconds of estimated work from which on it is refused.

    Raises
    ------
    ArgumentError
        If the work would take longer than the limit.

    Examples
    --------
    >>> one = DelaySystem((np.zeros((1, 1)), np.zeros((1, 1))), (np.array([[4.0]]), np.array([[3.0]])))
    >>> bool(abs(delay_margin(one).delay - scalar_margin(4.0, 3.0).delay) < 1e-12)
    True

    A lightly damped swing is unstable in a narrow band only:

    >>> prompt, late = (np.array([[1.0]]), np.array([[0.01]])), (np.array([[0.0101]]), np.array([[0.0]]))
    >>> round(delay_margin(DelaySystem(prompt, late)).delay, 5)
    1.43389
    """
    ensure_kind("system", system, DelaySystem, "what delay_system(...) gives")
    parts = list(system.strong_parts())
    for part in parts:
        _ensure_affordable(part, limit)
    if not _stable(system):
        return DelayMargin(0.0, float("nan"), 0.0)
    with progress_bar(len(parts), enabled=progress, counted=False) as advance:
        margins = [
            _margin_of_part(part, lambda share, k=k: advance(k + share, f"part {k + 1} of {len(parts)}"))  # type: ignore[misc]
            for k, part in enumerate(parts)
        ]
    first_margin = min(margins, key=lambda margin: margin.delay)
    return DelayMargin(first_margin.delay, first_margin.frequency, min(margin.least for margin in margins))


def _ensure_affordable(part: DelaySystem, limit: float) -> None:
    """Raise if computing the delay margin of a component would take longer than a time limit."""
    dimension = len(part.late[0])
    modes, spectra = _SECONDS * (2 * dimension) ** 3, _SPECTRA * _SECONDS_OF_SPECTRUM * dimension**3
    is_searched = spectra > limit and common_diagonals((*part.prompt, *part.late)) is None
    seconds = modes + spectra if is_searched else modes
    ensure_affordable(f"the delay margin of {dimension} coordinates", dimension, seconds, 2e-4 * dimension**2, limit)


def _margin_of_part(system: DelaySystem, advance: Callable[[float], object]) -> DelayMargin:
    """Return the delay margin of a strongly connected component of a delay system, taken by itself."""
    if system.highest == 0.0:
        return DelayMargin(inf, float("nan"), inf)
    unit = 2.0 ** int(np.log2(system.highest))  # of frequency: exact, and nothing overflows
    (k0, d0), (k1, d1) = system.prompt, system.late
    four = (k0 / unit / unit, d0 / unit, k1 / unit / unit, d1 / unit)
    stiffness = float(np.abs(four[0] + four[2]).max())
    top = 1.01 * system.highest / unit
    neutral, band = (NEUTRAL * stiffness, (_LOWEST * top, top)) if system.neutral else (0.0, (0.0, top))
    crossing = modal_crossing(four, neutral, band[0]) or _crossing_of_blocks(four, neutral, band, advance)
    delay = min(crossing.least, still_margin := _still_crossing(system) * unit)
    if still_margin < crossing.delay:
        return DelayMargin(still_margin / unit, 0.0, delay / unit)
    return DelayMargin(crossing.delay / unit, crossing.frequency * unit, delay / unit)


def _crossing_of_blocks(
    four: Four, neutral: float, band: tuple[float, float], advance: Callable[[float], object]
) -> Crossing:
    """Return the least delay crossing of the imaginary axis in a frequency band, searched block by block."""
    blocks, best, certified_delay = split_into_blocks(four, neutral=band[0] > 0.0), NO_CROSSING, inf
    for k, block in enumerate(blocks):
        crossing = None if block is four else modal_crossing(block, neutral, band[0])  # the whole has no common modes
        if crossing is None:
            crossing = least_crossing(block, *band, lambda share, k=k: advance((k + share) / len(blocks)), best)  # type: ignore[misc]
        certified_delay = min(certified_delay, crossing.least)
        best = min(best, crossing._replace(least=(1.0 - CLOSE) * crossing.delay))
    return best._replace(least=certified_delay)


def _still_crossing(system: DelaySystem) -> float:
    """Return the least delay at which another root reaches 0 without oscillating, due to neutral motions."""
    # There D − τK₁ on the kernel of K is singular where it is not for other delays.
    from scipy.linalg import eigvals

    if not system.neutral:
        return inf
    (k0, d0), (k1, d1) = system.prompt, system.late
    kernel, cokernel = kernels(k0 + k1)
    magnitudes = [float(np.abs(x).max()) or 1.0 for x in (d0 + d1, k1)]
    drag, pull = (cokernel.T @ x @ kernel / magnitude for x, magnitude in zip((d0 + d1, k1), magnitudes, strict=True))
    rows, columns = _range(np.hstack([drag, pull])), _range(np.vstack([drag, pull]).T)  # the rest drifts
    drag, pull, unit = (rows.T @ x @ columns for x in (drag, pull, cokernel.T @ kernel))
    if rows.shape != columns.shape or np.abs(pull).max(initial=0.0) <= ZERO:
        return inf
    early_roots: Any = eigvals(drag - _BRIEF * pull, unit)
    if np.any(early_roots.real < -ZERO):  # with any delay what drifted grows
        return 0.0
    delays: Any = eigvals(drag, pull)
    real = delays.real[np.isfinite(delays) & (np.abs(delays.imag) <= CLOSE * np.abs(delays)) & (delays.real > ZERO)]
    return float(real.min(initial=inf)) * magnitudes[0] / magnitudes[1]


def kernels(stiffness: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return orthonormal bases of the right and the left kernel of a stiffness matrix K."""
    rows = np.abs(stiffness).sum(axis=1)
    kernel = kernel_of(stiffness, np.where(rows > 0.0, rows, 1.0), ZERO, symmetric=False)
    return kernel.right, kernel.left


def _range(matrix: FloatArray) -> FloatArray:
    """Return an orthonormal basis of the column space of a matrix."""
    left, singular_values, _ = np.linalg.svd(matrix)
    return left[:, : int(np.sum(singular_values > ZERO))]


def _stable(system: DelaySystem) -> bool:
    """Return whether every root of the undelayed flock decays beyond rounding, neutral roots excepted."""
    # These are the smallest; and what is 0 to rounding is one of them, for no delay brings it onto the axis elsewhere.
    is_stable = []
    for component in system.strong_parts():
        (k0, d0), (k1, d1) = component.prompt, component.late
        is_stable.append(eigenvalues(np.block([[np.zeros_like(k0), np.eye(len(k0))], [-(k0 + k1), -(d0 + d1)]])))
    roots, errors = (np.concatenate(x) for x in zip(*is_stable, strict=True))
    is_neutral = np.abs(roots) <= errors
    is_neutral[np.argsort(np.abs(roots), kind="stable")[: system.neutral]] = True
    return bool(np.all(roots.real[~is_neutral] < -errors[~is_neutral]))
