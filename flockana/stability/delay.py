"""Delayed interactions: delay margins and characteristic roots.

x''(t) = −K₀ x(t) − D₀ x'(t) − K₁ x(t − τ) − D₁ x'(t − τ): all that an agent hears is τ old, and so is its own state
("all": K₀ = D₀ = 0); or the terms between agents, its own state in them included ("pairs": the γ-terms act at once); or
only what it hears of other agents ("neighbours": it knows its own state at once, so that the blocks of an agent with
itself are prompt).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import inf, nan, pi
from typing import Any

import numpy as np

from flockana.base.checks import (
    ComplexArray,
    FloatArray,
    ensure_count,
    ensure_kind,
    ensure_known,
    ensure_nonnegative,
    ensure_positive,
)
from flockana.base.progress import progress_bar
from flockana.equilibria.curvature import EPS
from flockana.laws import Law
from flockana.stability.blocks import NEUTRAL, is_pairs_and_pull, law_blocks
from flockana.stability.components import strong_components
from flockana.stability.crossings import CLOSE, least_crossing, modal_crossing
from flockana.stability.linearise import linearise
from flockana.stability.rounding import eigenvalues
from flockana.stability.zero_modes import ZERO, kernel_of

DELAYED = ("all", "pairs", "neighbours")
_ROUNDINGS = 16.0  # of eps times the terms of the characteristic matrix
_LOWEST = 1e-6  # of the highest frequency at which roots can cross: with neutral motions the search begins there


@dataclass(frozen=True)
class DelaySystem:
    """x'' = −K₀ x − D₀ x' − K₁ x(t−τ) − D₁ x'(t−τ)."""

    prompt: tuple[FloatArray, FloatArray]  # (K₀, D₀), shape (N, N)
    late: tuple[FloatArray, FloatArray]  # (K₁, D₁)
    neutral: int = 0  # roots at s = 0, whatever the delay: of rigid motions that nothing holds

    @property
    def highest(self) -> float:
        """Return a frequency above which no root crosses the imaginary axis, as s² dominates there."""
        k, d = (sum(float(np.linalg.norm(part[i], 2)) for part in (self.prompt, self.late)) for i in (0, 1))
        return 0.5 * (d + float(np.hypot(d, 2.0 * np.sqrt(k))))

    def characteristic(self, s: complex, delay: float) -> ComplexArray:
        """s² + K₀ + s D₀ + (K₁ + s D₁) e^(−sτ), singular at the roots."""
        (k0, d0), (k1, d1) = self.prompt, self.late
        return s * s * np.eye(len(k0)) + k0 + s * d0 + (k1 + s * d1) * np.exp(-s * delay)

    def slope(self, s: complex, delay: float) -> ComplexArray:
        """Return the derivative of `characteristic` by s."""
        (_, d0), (k1, d1) = self.prompt, self.late
        return 2.0 * s * np.eye(len(d0)) + d0 + (d1 - delay * (k1 + s * d1)) * np.exp(-s * delay)


@dataclass(frozen=True)
class DelayMargin:
    """The delay at which stability is lost.

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
        """Whether the delay is the margin, to a millionth; else the margin is at most the delay."""
        return self.least >= (1.0 - 2.0 * CLOSE) * self.delay


def delay_system(law: Law, q: Any, *, delayed: str = "all", strict: bool = True) -> DelaySystem:
    """The linearised flock whose interactions are delayed.

    Parameters
    ----------
    law : Law
        Algorithm 1 or 2, gains one for all or one per agent; with ``"all"`` any law that `linearise` takes.
    delayed : {"all", "pairs", "neighbours"}
        Everything, an agent's own state included; the terms between agents, its own state in them included; or only
        what these terms hear of other agents.
    strict : bool
        Refuse a state that is no equilibrium.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> one = delay_system(Algorithm2(target=StaticTarget((0.0,))), [[0.0]])
    >>> [block.tolist() for block in one.late], one.neutral
    ([[[1.1]], [[2.0976176963403033]]], 0)
    """
    ensure_known("set of delayed terms", delayed, DELAYED)
    if delayed == "all" and isinstance(law, Law) and not is_pairs_and_pull(law):
        found = linearise(law, q, allow_residual=not strict)
        k, d, rest = found.stiffness.toarray(), found.damping.toarray(), found.second_order.invariant
        zero = np.zeros_like(k)
        return DelaySystem((zero, zero), (k, d), len(rest.zero) + rest.chains)
    flock = law_blocks(law, q, strict=strict)
    neutral, zero = flock.neutral.shape[1] + flock.drifting.shape[1], np.zeros_like(flock.stiffness)
    if delayed == "all":
        return DelaySystem((zero, zero), (flock.stiffness, flock.damping), neutral)
    prompt_k, prompt_d = zero.copy(), zero.copy()
    if delayed == "neighbours":
        m = np.shape(q)[1]
        itself = np.kron(np.eye(len(zero) // m), np.ones((m, m))) > 0.0  # each agent's own block
        prompt_k[itself], prompt_d[itself] = flock.stiffness[itself], flock.damping[itself]
        # delayed neighbours of a drifting flock appear behind, which slows it down unless no force acts along the drift
        held = np.linalg.matrix_rank(flock.drifting.T @ prompt_k @ flock.drifting, tol=NEUTRAL * np.abs(prompt_k).max())
        neutral -= int(held)
    elif law.target is not None:
        gains: Any = law.gains  # type: ignore[attr-defined]  # Algorithm 2 has them
        shape, own = np.shape(q), np.diag_indices(len(zero))
        prompt_k[own] = np.broadcast_to(gains.pull, shape).ravel()
        prompt_d[own] = np.broadcast_to(gains.drag, shape).ravel()
    return DelaySystem((prompt_k, prompt_d), (flock.stiffness - prompt_k, flock.damping - prompt_d), neutral)


def scalar_margin(k: float, d: float) -> DelayMargin:
    """Delay margin of x'' = −k x(t−τ) − d x'(t−τ) in closed form.

    On the axis k + jωd = ω² e^jωτ: ω² = (d² + √(d⁴ + 4k²))/2 and τ = atan2(ωd, k)/ω.

    Parameters
    ----------
    k, d : float
        Stiffness and damping, both >= 0.

    Examples
    --------
    >>> round(scalar_margin(0.0, 2.0).delay / pi, 12)
    0.25
    """
    k, d = ensure_nonnegative("k", k), ensure_nonnegative("d", d)
    if k == 0.0 and d == 0.0:
        return DelayMargin(inf, float("nan"))
    unit = max(d, float(np.sqrt(k)))  # nothing overflows
    k, d = k / unit / unit, d / unit
    omega = float(np.sqrt(0.5 * (d * d + np.hypot(d * d, 2.0 * k))))
    return DelayMargin(float(np.arctan2(omega * d, k)) / omega / unit, omega * unit)


def delay_margin(system: DelaySystem, *, progress: bool = False) -> DelayMargin:
    """The least delay at which a root reaches the imaginary axis.

    In closed form or by a polynomial for each mode where prompt and late parts share their modes, symmetric or not;
    else by a search over all frequencies that excludes whole intervals by a bound (`flockana.stability.crossings`): no
    band is too narrow for it. Parts that hear others and are not heard by them are looked at by themselves. Neutral
    motions are set apart; a flock that has any is searched from a millionth of its highest frequency on.

    Parameters
    ----------
    system : DelaySystem
        Stable without delay, but for neutral motions.

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
    if not _stable(system):
        return DelayMargin(0.0, float("nan"), 0.0)
    parts = list(_strong_parts(system))
    with progress_bar(len(parts), enabled=progress, counted=False) as advance:
        margins = [
            _margin_of_part(part, lambda share, k=k: advance(k + share, f"part {k + 1} of {len(parts)}"))  # type: ignore[misc]
            for k, part in enumerate(parts)
        ]
    first = min(margins, key=lambda margin: margin.delay)
    return DelayMargin(first.delay, first.frequency, min(margin.least for margin in margins))


def _margin_of_part(system: DelaySystem, advance: Callable[[float], object]) -> DelayMargin:
    """Return the delay margin of a part that depends on no other part."""
    if system.highest == 0.0:
        return DelayMargin(inf, float("nan"), inf)
    unit = 2.0 ** int(np.log2(system.highest))  # of frequency: exact, and nothing overflows
    (k0, d0), (k1, d1) = system.prompt, system.late
    four = (k0 / unit / unit, d0 / unit, k1 / unit / unit, d1 / unit)
    stiffness = float(np.abs(four[0] + four[2]).max())
    found = modal_crossing(four, NEUTRAL * stiffness if system.neutral else 0.0)
    if found is None:
        top = 1.01 * system.highest / unit
        found = least_crossing(four, _LOWEST * top if system.neutral else 0.0, top, advance)
    return DelayMargin(found.delay / unit, found.frequency * unit, found.least / unit)


def _strong_parts(system: DelaySystem) -> Iterator[DelaySystem]:
    """Strongly connected parts: the roots of the whole are those of its parts, each taken by itself."""
    matrices = (*system.prompt, *system.late)
    for rows in strong_components(*matrices).indices:
        own = np.ix_(rows, rows)
        k0, d0, k1, d1 = (part[own] for part in matrices)
        yield DelaySystem((k0, d0), (k1, d1), system.neutral)


def _stable(system: DelaySystem) -> bool:
    """Return whether every root without delay decays beyond rounding, neutral roots excepted."""
    # These are the smallest; and what is 0 to rounding is one of them, for no delay brings it onto the axis elsewhere.
    found = []
    for part in _strong_parts(system):
        (k0, d0), (k1, d1) = part.prompt, part.late
        found.append(eigenvalues(np.block([[np.zeros_like(k0), np.eye(len(k0))], [-(k0 + k1), -(d0 + d1)]])))
    roots, errors = (np.concatenate(x) for x in zip(*found, strict=True))
    neutral = np.abs(roots) <= errors
    neutral[np.argsort(np.abs(roots), kind="stable")[: system.neutral]] = True
    return bool(np.all(roots.real[~neutral] < -errors[~neutral]))


def rightmost_roots(system: DelaySystem, delay: float, *, nodes: int = 16, count: int = 6) -> ComplexArray:
    """The rightmost characteristic roots, neutral ones left out, by Chebyshev collocation of the generator.

    The delayed state over [−τ, 0] is a polynomial through nodes + 1 Chebyshev points (Breda, Maset, Vermiglio 2005);
    each root is then refined by Newton's method on the characteristic matrix itself, which has no such error.

    Parameters
    ----------
    system : DelaySystem
        The linearised flock.
    delay : float
        τ > 0.
    nodes : int
        Degree of the polynomial; the matrix has 2N (nodes + 1) rows.
    count : int
        Roots wanted; conjugates count too.

    Returns
    -------
    complex ndarray, shape (count,)
        Largest real part first.

    Examples
    --------
    At the margin of x'' = −x'(t − τ) the roots ±j are the rightmost:

    >>> one = DelaySystem((np.zeros((1, 1)), np.zeros((1, 1))), (np.zeros((1, 1)), np.ones((1, 1))), neutral=1)
    >>> [round(float(abs(s)), 9) for s in rightmost_roots(one, 0.5 * pi, count=2) - np.array([1j, -1j])]
    [0.0, 0.0]
    """
    ensure_kind("system", system, DelaySystem, "what delay_system(...) gives")
    delay, nodes, count = ensure_positive("delay", delay), ensure_count("nodes", nodes), ensure_count("count", count)
    parts = list(_strong_parts(system))
    neutral = [_neutral_roots(part, delay) for part in parts] if len(parts) > 1 else [system.neutral]
    each = zip(parts, neutral, strict=True)
    found = np.concatenate([_rightmost_of_part(part, zeros, delay, nodes, count) for part, zeros in each])
    found = found[np.argsort(-found.real, kind="stable")]
    pairs = [(s,) if s.imag == 0.0 else (s, s.conjugate()) for s in found.tolist()]  # each with its conjugate
    return np.array([s for pair in pairs for s in pair], dtype=np.complex128)[:count]


def _neutral_roots(part: DelaySystem, delay: float) -> int:
    """Return how many roots a strongly connected part has at s = 0 for a delay."""
    if part.neutral == 0:
        return 0
    (k0, d0), (k1, d1) = part.prompt, part.late
    rows = np.abs(k0 + k1).sum(axis=1)
    kernel = kernel_of(k0 + k1, np.where(rows > 0.0, rows, 1.0), ZERO, symmetric=False)
    slope = d0 + d1 - delay * k1
    drag, terms = kernel.left.T @ slope @ kernel.right, np.abs(kernel.left).T @ np.abs(slope) @ np.abs(kernel.right)
    held = np.linalg.matrix_rank(drag, tol=ZERO * float(terms.max(initial=0.0))) if drag.size else 0
    return 2 * kernel.right.shape[1] - int(held)


def _rightmost_of_part(system: DelaySystem, neutral: int, delay: float, nodes: int, count: int) -> ComplexArray:
    """Return the rightmost roots with Im s >= 0 of a strongly connected part, `neutral` roots at 0 left out."""
    (k0, d0), (k1, d1) = system.prompt, system.late
    size, zero, one = len(k0), np.zeros_like(k0), np.eye(len(k0))
    now, then = np.block([[zero, one], [-k0, -d0]]), np.block([[zero, zero], [-k1, -d1]])
    if not then.any():  # nothing is late
        nodes, generator = 0, now
    else:
        generator = np.kron(_chebyshev(nodes) * (2.0 / delay), np.eye(2 * size))
        generator[: 2 * size] = 0.0
        generator[: 2 * size, : 2 * size] = now
        generator[: 2 * size, -2 * size :] += then
    values = np.linalg.eigvals(generator)
    values = np.delete(values, np.argsort(np.abs(values), kind="stable")[:neutral])
    upper = values[values.imag >= 0.0]
    upper = upper[np.argsort(-upper.real, kind="stable")][:count]
    return np.array([_refine(system, complex(s), delay) for s in upper], dtype=np.complex128)


def root_error(system: DelaySystem, s: complex, delay: float) -> float:
    """Return an error bound of a refined root, from the residual and rounding."""
    (k0, d0), (k1, d1) = system.prompt, system.late
    u, sizes, vh = np.linalg.svd(system.characteristic(s, delay))
    late, turn = np.exp(-s * delay), abs(complex(u[:, -1].conj() @ system.slope(s, delay) @ vh[-1].conj()))
    size = float(np.linalg.norm(k0) + abs(s) * np.linalg.norm(d0))
    size += abs(late) * float(np.linalg.norm(k1) + abs(s) * np.linalg.norm(d1)) + abs(s) ** 2
    push = float(sizes[-1]) + _ROUNDINGS * EPS * size
    return float(min(push / turn if turn > 0.0 else inf, np.sqrt(push)))


def _chebyshev(nodes: int) -> FloatArray:
    """Differentiation matrix on the Chebyshev points cos(πk/nodes), from 1 to −1 (Trefethen 2000, chapter 6)."""
    k = np.arange(nodes + 1)
    x = np.cos(pi * k / nodes)
    weight = np.where((k == 0) | (k == nodes), 2.0, 1.0) * (-1.0) ** k
    matrix = np.outer(weight, 1.0 / weight) / (x[:, None] - x[None, :] + np.eye(nodes + 1))
    return matrix - np.diag(matrix.sum(axis=1))


def _refine(system: DelaySystem, s: complex, delay: float) -> complex:
    """Newton's method for (v, s) with M(s) v = 0, started from the singular vector at s."""
    start = s
    v = np.linalg.svd(system.characteristic(s, delay))[2][-1].conj()
    fixed = v.conj()
    for _ in range(8):
        matrix, slope = system.characteristic(s, delay), system.slope(s, delay) @ v
        bordered = np.block([[matrix, slope[:, None]], [fixed[None, :], np.zeros((1, 1))]])
        try:
            step = np.linalg.solve(bordered, np.append(-matrix @ v, 1.0 - fixed @ v))
        except np.linalg.LinAlgError:
            break
        v, s = v + step[:-1], s + complex(step[-1])
        if abs(step[-1]) <= 1e-14 * max(abs(start), 1.0 / delay):
            break
    near = abs(s - start) <= 0.1 * max(abs(start), 1.0 / delay)
    return s if near and np.isfinite(s) else start
