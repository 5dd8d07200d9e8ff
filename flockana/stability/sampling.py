"""Largest sampling period or step for which a flock near its equilibrium is stable.

A sampled loop holds the input u for a period h. With K and D of the flow, q' = q + h p + f h² u, p' = p + h u, where
f = ½ is the exact motion under a held input and the Taylor step, 0 explicit and 1 semi-implicit Euler, 3/2 the MSN
project's map. With z = (1 + hs/2)/(1 − hs/2) the multipliers z lie in the unit disc where M s² + C s + K has its roots
in the left half plane, M = 1 − hD/2 + (1 − 2f)h²K/4 and C = D − (1 − f)hK. For one mode that is

    k > 0,  d > (1 − f) h k,  4 − 2hd + (1 − 2f)h²k > 0.

For symmetric K and D that do not commute, M > 0 and C > 0 suffice, and a root leaves at z = −1 exactly where M is
singular, so that for f >= 1 the margin is the least h with a singular M. Explicit Euler multiplies by 1 + hλ, so that
its margin is the least −2 Re λ/|λ|². Else the margin lies between the bound and the first growth that a search meets.
"""

from dataclasses import dataclass, field
from math import inf, isnan, nan, sqrt
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray, ensure_affordable, ensure_fits, ensure_nonnegative, ensure_positive
from flockana.equilibria.curvature import EPS
from flockana.stability.cost_estimates import LIMIT
from flockana.stability.linear_flock import LinearFlock
from flockana.stability.map_linearisation import moved_before, stepped_equation
from flockana.stability.modes import SecondOrder
from flockana.stability.unstable_steps import CLOSE, MOST, Growth, Steps, first_growth

_COMMUTE = 1e-10  # relative: of K D − D K that counts as 0
_SECONDS, _SECONDS_OF_INTERVALS = 2e-9, 7.5e-7  # per cubed number of states: of all modes, of certified intervals
_UNDAMPED = 1e-10  # of the largest damping rate


@dataclass(frozen=True)
class ModePeriod:
    """Largest sampling period for which one mode is stable.

    Parameters
    ----------
    period : float
        h at which the mode stops to decay; infinite if it always decays.
    multiplier : complex
        z there, on the unit circle: −1 where the mode changes sign at each sample.
    shape : ndarray, shape (n, m)
        Displacements, of unit length together.
    """

    period: float
    multiplier: complex
    shape: npt.NDArray[Any] = field(repr=False)

    @property
    def frequency(self) -> float:
        """Frequency of the marginal oscillation at the largest stable period, in radians per time unit."""
        return abs(float(np.angle(self.multiplier))) / self.period if 0.0 < self.period < inf else nan


@dataclass(frozen=True)
class SamplingMargin:
    """Largest period for which the sampled flock is stable, and the mode that becomes unstable first.

    Parameters
    ----------
    scheme : str
        Name of the scheme.
    period : float
        Margin: beyond it one mode grows. 0 if none is stable; infinite where nothing can grow; NaN if it is not known.
    least : float
        Certified: every shorter period is stable. By default the margin itself.
    modes : tuple of ModePeriod
        Modes with their periods, the first to go first. In closed form where K and D commute; else those that flip (of
        explicit Euler all), and the one that goes first, if it is known.

    Examples
    --------
    >>> SamplingMargin("hold", 0.2, 0.2, ()).times(0.05), SamplingMargin("hold", 0.2, 0.1, ()).certified
    (4.0, False)
    """

    scheme: str
    period: float
    least: float
    modes: tuple[ModePeriod, ...] = field(repr=False)

    @property
    def certified(self) -> bool:
        """Return whether the sampling margin is accurate to a millionth; otherwise it is at most `period`."""
        return self.least >= (1.0 - CLOSE) * self.period

    @property
    def first(self) -> ModePeriod | None:
        """Mode that becomes unstable first; None if there is none."""
        return self.modes[0] if self.modes else None

    def times(self, dt: float) -> float:
        """Return the sampling margin divided by the step `dt`; above 1 the sampled flock is stable.

        Parameters
        ----------
        dt : float
            Step in use.
        """
        return self.period / ensure_positive("dt", dt)


def scalar_period(k: float, d: float, factor: float = 0.5) -> tuple[float, complex]:
    """Return the largest stable sampling period of x'' = −k x − d x', and the multiplier there.

    A damper alone, k = 0, keeps the multiplier 1 of its place, which is neutral.

    Parameters
    ----------
    k, d : float
        Stiffness and damping, both >= 0.
    factor : float
        f of q' = q + h p + f h² u.

    Examples
    --------
    A mass with a spring under a held input needs damping, and bears h < 2d/k if it is weak:

    >>> scalar_period(4.0, 0.1)[0], scalar_period(4.0, 0.0)[0], scalar_period(0.0, 4.0)
    (0.05, 0.0, (0.5, (-1+0j)))

    Semi-implicit Euler bears a damped swing up to nearly h = 2/ω:

    >>> round(scalar_period(4.0, 1e-9, 1.0)[0], 8)
    1.0
    """
    k, d = ensure_nonnegative("k", k), ensure_nonnegative("d", d)
    flip_period = _flip(k, d, factor)
    if k == 0.0:
        return (flip_period, -1.0 + 0.0j) if d > 0.0 else (0.0, 1.0 + 0.0j)
    if factor >= 1.0:
        return (flip_period, -1.0 + 0.0j) if d > 0.0 or factor > 1.0 else (0.0, 1.0 + 0.0j)
    turn = d / ((1.0 - factor) * k)
    if flip_period <= turn:
        return flip_period, -1.0 + 0.0j
    half_trace = 1.0 - 0.5 * turn * (d + factor * turn * k)  # cos of the angle: half the trace, of determinant 1
    return turn, complex(half_trace, sqrt(max(0.0, 1.0 - half_trace * half_trace)))


def _flip(k: float, d: float, factor: float) -> float:
    """Return the least h > 0 with 4 − 2hd + (1 − 2f)h²k = 0, infinite without one."""
    a, radicand = (1.0 - 2.0 * factor) * k, d * d - 4.0 * (1.0 - 2.0 * factor) * k
    if radicand < 0.0 or d + sqrt(radicand) <= 0.0:
        return inf
    return 4.0 / (d + sqrt(radicand)) if a != 0.0 or d > 0.0 else inf


def margin_of_flow(
    name: str, flow: LinearFlock, factor: float = 0.5, *, in_place: bool = False, limit: float = LIMIT
) -> SamplingMargin:
    """Return the sampling margin of a linearised flock with a hold, or of a map with a `factor`."""
    ensure_fits("A", flow.A_sparse.shape, "ask of fewer agents")
    problem, is_certain = flow.second_order, flow.second_order.symmetric and not in_place
    dimension, task_text = flow.q.size, f"the modes of {len(flow.q)} agents"
    ensure_affordable(task_text, dimension, _SECONDS * (2 * dimension) ** 3, 1e-4 * dimension**2, limit)
    if not (is_certain and factor >= 1.0) and factor > 0.0:
        states = [2 * component.q.size for component in problem.parts or (problem,)]
        seconds = sum(_SECONDS_OF_INTERVALS * x**3 for x in states if x > MOST)
        task_text = f"the sampling margin of {len(flow.q)} agents, {max(states)} states in one component,"
        ensure_affordable(task_text, dimension, seconds, 1e-3 * max(states) ** 2, limit)
    k, d = flow.stiffness.toarray(), flow.damping.toarray()
    symmetric, shape = flow.second_order.symmetric, flow.q.shape
    if factor == 0.0 and not in_place:
        is_explicit = _explicit(flow)
    elif symmetric and not in_place:
        is_explicit = _symmetric(flow, 0.5 * (k + k.T), 0.5 * (d + d.T), factor)
    else:
        is_explicit = _first_to_grow(flow, factor, in_place=in_place)
    shortest, modes = is_explicit
    modes = sorted(modes, key=lambda mode: -inf if isnan(mode.period) else mode.period)
    period = modes[0].period if modes else inf
    modes = [mode for mode in modes if not isnan(mode.period)]
    periods = (ModePeriod(x.period, x.multiplier, np.reshape(x.shape, shape)) for x in modes)
    return SamplingMargin(name, period, shortest if isnan(period) else min(shortest, period), tuple(periods))


def _explicit(flow: LinearFlock) -> tuple[float, list[ModePeriod]]:
    """Return the explicit-Euler margins by eigenvalue: |1 + hλ| < 1 for h < −2 Re λ/|λ|²."""
    modes = []
    for mode in flow.modes:
        value = mode.eigenvalue
        period = max(0.0, -2.0 * value.real / abs(value) ** 2) if mode.decays else 0.0
        modes.append(ModePeriod(period, 1.0 + period * value, mode.shape))
    return inf, modes


def _symmetric(flow: LinearFlock, k: FloatArray, d: FloatArray, factor: float) -> tuple[float, list[ModePeriod]]:
    """Return a certified bound of the sampling period, and modes, for symmetric K and D."""
    scale = float(np.abs(k).max() * np.abs(d).max())
    if scale == 0.0 or np.abs(k @ d - d @ k).max() <= _COMMUTE * scale:
        return inf, _modal(k, d, factor)
    if not flow.stable and factor <= 1.0:
        return 0.0, [ModePeriod(0.0, 1.0 + 0.0j, flow.modes[0].shape)]
    flip_modes = _flips(k, d, factor)
    flip_period = min((mode.period for mode in flip_modes), default=inf)
    if factor >= 1.0:
        return inf, flip_modes
    period_limit = _least_damped(k, d) / (1.0 - factor)
    if flip_period <= period_limit:
        return inf, flip_modes
    shortest, first_modes = _first_to_grow(flow, factor, stable_below=period_limit)
    return shortest, [*first_modes, *flip_modes]


def _modal(k: FloatArray, d: FloatArray, factor: float) -> list[ModePeriod]:
    """Return the sampling margin of each mode in closed form, for K and D with common modes."""
    magnitudes = [float(np.abs(x).max()) or 1.0 for x in (k, d)]
    shapes = np.linalg.eigh(k / magnitudes[0] + sqrt(2.0) * d / magnitudes[1])[1]
    rows = []
    for v in shapes.T:
        pairs = zip((v @ k @ v, v @ d @ v), magnitudes, strict=True)
        mode_stiffness, drag = (0.0 if abs(x) <= _UNDAMPED * magnitude else x for x, magnitude in pairs)
        if mode_stiffness < 0.0 or drag < 0.0:
            rows.append(ModePeriod(0.0, 1.0 + 0.0j, v))
        elif mode_stiffness > 0.0 or drag > 0.0:
            rows.append(ModePeriod(*scalar_period(mode_stiffness, drag, factor), v))
    return rows


def _flips(k: FloatArray, d: FloatArray, factor: float) -> list[ModePeriod]:
    """Return the periods at which 4 − 2hD + (1 − 2f)h²K is singular, by eigenvalues 1/h."""
    dimension, a = len(k), (1.0 - 2.0 * factor)
    if a == 0.0:
        values, vectors = np.linalg.eigh(0.5 * d)
    else:
        companion = np.block([[np.zeros_like(k), np.eye(dimension)], [-0.25 * a * k, 0.5 * d]])
        values, vectors = np.linalg.eig(companion)
        real = np.abs(values.imag) <= sqrt(EPS) * np.abs(values)
        values, vectors = values.real[real], vectors.real[:dimension, real]
    is_damped = values > _UNDAMPED * float(np.abs(values).max(initial=0.0))
    flip_modes = zip(1.0 / values[is_damped], (vectors / np.linalg.norm(vectors, axis=0)).T[is_damped], strict=True)
    return [ModePeriod(float(h), -1.0 + 0.0j, v) for h, v in flip_modes]


def _least_damped(k: FloatArray, d: FloatArray) -> float:
    """Return the largest h with D − hK positive definite off the kernel of K; 0 if D is not."""
    values, vectors = np.linalg.eigh(k)
    held_vectors = vectors[:, values > 1e-8 * float(np.abs(values).max())]
    null_vectors = vectors[:, values <= 1e-8 * float(np.abs(values).max())]
    inner = d
    if null_vectors.shape[1]:  # what K does not hold may give way: the Schur complement
        drag = null_vectors.T @ d @ null_vectors
        inner = d - d @ null_vectors @ np.linalg.pinv(drag, rcond=1e-10, hermitian=True) @ null_vectors.T @ d
    stiffness_values = np.linalg.eigvalsh(k)[-held_vectors.shape[1] :] if held_vectors.size else np.zeros(0)
    scaled_vectors = held_vectors / np.sqrt(stiffness_values) if held_vectors.size else held_vectors
    return float(np.linalg.eigvalsh(scaled_vectors.T @ inner @ scaled_vectors)[0]) if held_vectors.size else inf


def _first_to_grow(
    flow: LinearFlock, factor: float, *, in_place: bool = False, stable_below: float = 0.0
) -> tuple[float, list[ModePeriod]]:
    """Return (certified bound, first growing mode) by components; NaN period if unknown."""
    problem, m = flow.second_order, flow.q.shape[1]
    before = [moved_before(x, m) if in_place else 0.0 * x for x in (flow.stiffness.tocsr(), flow.damping.tocsr())]
    first, shortest, part_of = Growth(inf, inf), inf, None
    for k, part in enumerate(problem.parts or (problem,)):
        rows = problem.net.indices[k] if problem.net else np.arange(flow.q.size)
        steps = _steps(part, [x[rows][:, rows].toarray() for x in before], factor)
        if in_place and part.invariant.chains:  # what drifts is pushed on by those who have moved before
            growth = Growth(nan, 0.0)
        elif not part.stable and factor <= 1.0:
            growth = Growth(0.0, 0.0)
        else:
            growth = first_growth(steps, part.pace, stable_below)
            if growth.period == 0.0 and part.stable:  # shorter than any step that is looked at
                growth = Growth(nan, 0.0)
        shortest = min(shortest, growth.least)
        if not growth.period >= first.period:
            first, part_of = growth, steps
    if part_of is None or first.period == inf:
        return shortest, []
    if not first.period > 0.0:
        shape = flow.modes[0].shape if flow.modes else flow.q
        return shortest, [ModePeriod(first.period, 1.0 + 0.0j, shape)]
    z = max(part_of.multipliers(first.period).tolist(), key=lambda z: (round(abs(z), 9), z.imag))
    k, d = (
        x.toarray() for x in stepped_equation(flow.stiffness, flow.damping, first.period, factor, m, in_place=in_place)
    )
    w = (z - 1.0) / first.period
    shape = np.linalg.svd(w * w * np.eye(len(k)) + w * d + k)[2][-1].conj()
    return shortest, [ModePeriod(first.period, z / abs(z), shape)]


def _steps(problem: SecondOrder, before: list[FloatArray], factor: float) -> Steps:
    """Return the step equation of a map off the zero modes; `before` holds the immediate entries."""
    quotient, dimension = problem.quotient, problem.q.size
    low, zero = quotient.basis[dimension:], np.zeros((len(quotient.A),) * 2)
    stiffness = problem.stiffness.toarray()
    e1, e2 = low.T @ before[1] @ low, factor * low.T @ before[0] @ low
    return Steps(e1, e2, e1 + quotient.A, e2 - low.T @ (factor * stiffness + before[0]) @ low + zero)
