"""Solutions of a law matched to noisy samples, with an estimated start for each window of samples.

Parameters and starts are sought together by the method of Gauss and Newton. Residuals are divided by the noise, so that
they are independent with deviation 1, and an error of the integration whose residuals have the norm x moves a parameter
by at most x standard errors; the steps are chosen by it. Constant errors of the samples are parameters, too, each with
its own spread.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.base.value_checks import FloatArray
from flockana.recorded.matching_windows import Window, neighbouring_laws

_ROUNDS = 120  # residuals that are computed at most
_GAIN = 1e-2  # of squared deviations, that a round must promise for the search to go on
_FINEST = 32  # times finer steps may be
_BLURRED = 0.05  # standard errors that the integration may move a parameter by
_COARSE, _FINE = 0.4, 0.1  # of the law's time, over which slopes are carried by one linearisation, at first and at last
_CLOSE = 0.3  # gain that coarse slopes promise, from which on they are fine
_NEAR = 1.0  # gain of steps by the same slopes, within which these still give the covariance
_LEAST = 1e-6  # of its first value, below which no positive parameter goes
_FELT = 1e-6  # least change of the squared residuals by doubling a parameter that makes it identifiable
_DAMPED = 1e8  # damping beyond which nothing is left to try
_SLOW = 4  # rounds one after another that gain nothing to speak of, whatever slopes promise
_TRUSTED = 0.5  # by which a gain may differ from the one that slopes promise; else they are computed anew
_STEEPEST = 1e100  # slope of a residual, whose squares would soon overflow


@dataclass(frozen=True, eq=False)
class Problem:
    """Problem of fitting a law's unknown parameters, and constant sample errors, to windows of samples."""

    parts: list[Window]
    with_values: Callable[[FloatArray], Any]
    first: FloatArray  # parameters to begin with, of which positive ones stay positive
    spread: FloatArray | None = None  # deviation of a constant error of each number, (w,); 0 for none

    @property
    def size(self) -> int:
        """Number of recorded position and velocity components in all windows, without gaps."""
        return sum(int(np.count_nonzero(segment.root)) for segment in self.parts)

    def fixed(self, k: int, value: float) -> Self:
        """Return the fitting problem with one parameter fixed at a value, and the others free."""

        def law(z: FloatArray) -> Any:
            return self.with_values(np.insert(z, k, value))

        return replace(self, with_values=law, first=np.delete(self.first, k))

    def split(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the law's parameters and the constant errors of all coordinates, (w,), from the unknowns z."""
        count = len(self.first)
        if self.spread is None:
            return z, np.zeros(self.parts[0].y.shape[1])
        shift = np.zeros(len(self.spread))
        shift[self.spread > 0.0] = z[count:]
        return z[:count], shift

    def residuals(self, z: FloatArray, starts: Sequence[FloatArray], finer: int) -> list[FloatArray] | None:
        """Return residuals of all windows; None if the law refuses the parameters, or its solution is not finite."""
        theta, shift = self.split(z)
        try:
            law = self.with_values(theta)
            misfits = [part.residual(law, start, finer, shift) for part, start in zip(self.parts, starts, strict=False)]
        except FlockanaError:
            return None
        if self.spread is not None:
            misfits.append(-z[len(theta) :] / self.spread[self.spread > 0.0])
        return misfits if all(np.isfinite(misfit).all() for misfit in misfits) else None

    def slopes(self, z: FloatArray, starts: Sequence[FloatArray], finer: int, block: float) -> list[FloatArray]:
        """Return slopes of each window's solution, over deviations, by start, parameters and constant errors."""
        theta, _ = self.split(z)
        law, nearby = self.with_values(theta), neighbouring_laws(self.with_values, theta)
        with np.errstate(over="ignore", invalid="ignore"):
            rows = [
                part.slopes(law, nearby, start, finer, block) for part, start in zip(self.parts, starts, strict=False)
            ]
        if not all(np.abs(row).max(initial=0.0) < _STEEPEST for row in rows):
            raise ArgumentError("the slopes of the law's solution overflow: expected other first parameters")
        if self.spread is None:
            return rows
        active, wide = np.flatnonzero(self.spread > 0.0), []
        for part, row in zip(self.parts, rows, strict=True):
            by_shift = np.zeros((*part.root.shape, len(active)))
            by_shift[:, active, np.arange(len(active))] = part.root[:, active]
            wide.append(np.concatenate([row, by_shift.reshape(len(row), -1)], axis=1))
        prior = np.concatenate([np.zeros((len(active), len(theta))), np.diag(1.0 / self.spread[active])], axis=1)
        return [*wide, prior]


class MatchResult(NamedTuple):
    """Result of a fit: parameters, covariance for unit noise, window starts, residuals, and degrees of freedom."""

    values: FloatArray  # of the law, then constant errors
    covariance: FloatArray
    identifiable: npt.NDArray[np.bool_]  # parameters that the residuals feel
    starts: list[FloatArray]
    residuals: list[FloatArray]
    freedom: float
    message: str
    normal: "NormalEquations"
    finer: int

    @property
    def squares(self) -> float:
        """Sum of the squared residuals of the fit."""
        return _squares(self.residuals)

    @property
    def variance(self) -> float:
        """Variance of the fit's residuals, in units of the assumed noise variance."""
        return self.squares / self.freedom


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """Least-squares normal equations of window starts and parameters, with the starts eliminated."""

    slopes: list[FloatArray]
    corners: list[FloatArray]  # inverse of each start's own block
    across: list[FloatArray]  # block between a start and the parameters
    reduced: FloatArray
    damping: float

    @classmethod
    def of(cls, slopes: list[FloatArray], count: int, damping: float) -> Self:
        """Return the normal equations from derivatives, the last `count` columns of which are by parameters."""
        reduced_matrix, corners, cross_blocks = np.zeros((count, count)), [], []
        for slope in slopes:
            gram_matrix = slope.T @ slope
            gram_matrix[np.diag_indices_from(gram_matrix)] *= 1.0 + damping
            size = len(gram_matrix) - count
            corners.append(inverse(gram_matrix[:size, :size]))
            cross_blocks.append(gram_matrix[:size, size:])
            reduced_matrix += gram_matrix[size:, size:] - cross_blocks[-1].T @ corners[-1] @ cross_blocks[-1]
        return cls(slopes, corners, cross_blocks, reduced_matrix, damping)

    @property
    def covariance(self) -> FloatArray:
        """Covariance of the fitted parameters for noise of standard deviation 1."""
        return inverse(self.reduced)

    def without(self, k: int) -> Self:
        """Return the normal equations with one parameter fixed."""
        count = len(self.reduced)
        return self.of([np.delete(x, x.shape[1] - count + k, axis=1) for x in self.slopes], count - 1, self.damping)

    def step(self, residuals: list[FloatArray]) -> tuple[FloatArray, list[FloatArray], float]:
        """Return the steps of parameters and of each start, and the predicted decrease of squared residuals."""
        count, starts, gain_sum = len(self.reduced), [], 0.0
        gradients = [slope.T @ residual for slope, residual in zip(self.slopes, residuals, strict=True)]
        parts = [(x[: x.size - count], x[x.size - count :]) for x in gradients]
        blocks = list(zip(parts, self.corners, self.across, strict=True))
        theta_step = self.covariance @ sum(
            (own_block - across.T @ (corner @ start) for (start, own_block), corner, across in blocks), np.zeros(count)
        )
        for (start, own_block), corner, across in blocks:
            starts.append(corner @ (start - across @ theta_step))
            gain_sum += float(start @ starts[-1]) + float(own_block @ theta_step)
        return theta_step, starts, gain_sum


def inverse(matrix: FloatArray) -> FloatArray:
    """Return the pseudoinverse of a symmetric matrix scaled to a unit diagonal."""
    if not len(matrix):
        return matrix
    scales = np.sqrt(np.maximum(np.diag(matrix), 0.0))  # rounding leaves less than 0
    unit = np.divide(1.0, scales, out=np.zeros_like(scales), where=scales > 0.0)
    return unit[:, None] * np.linalg.pinv(unit[:, None] * matrix * unit, 1e-14, hermitian=True) * unit


def matched(
    problem: Problem,
    *,
    starts: Sequence[FloatArray] | None = None,
    values: FloatArray | None = None,
    finer: int | None = None,
    block: float = _COARSE,
    rounds: int = _ROUNDS,
    normal: NormalEquations | None = None,
) -> MatchResult:
    """Return the law parameters and window starts whose solutions fit the samples best.

    Slopes, at first those of `normal`, are kept as long as steps gain what they promise: most rounds cost solutions
    alone.
    """
    theta, damping = _first(problem, values), 0.0
    starts = _with_prior(problem, [segment.start for segment in problem.parts] if starts is None else list(starts))
    if finer is None:
        finer = _refinement(problem.parts, problem.with_values(problem.split(theta)[0]))
    total_gain, slow_steps, message = 0.0, 0, ""
    now = problem.residuals(theta, starts, finer)
    if now is None:
        raise ArgumentError("the law cannot be integrated from the recorded starts: expected other first parameters")
    size = problem.size
    for _ in range(rounds):
        if normal is None:
            total_gain, normal = 0.0, _normal(problem, theta, starts, finer, block, damping=damping)
        step, start_steps, expected_gain = normal.step(now)
        unit = max(_squares(now) / size, 1.0)  # residuals of a law that does not fit are larger than noise
        if expected_gain <= (_GAIN if block == _FINE else _CLOSE) * unit:
            if block == _FINE and total_gain <= _NEAR * unit and normal.damping == 0.0:
                message = "settled"
                break
            block, damping, normal = _FINE, 0.0, None
            continue
        step_share = _share(theta, step, problem.first)
        tried_theta = theta + step_share * step
        tried_starts = [x + step_share * start_step for x, start_step in zip(starts, start_steps, strict=True)]
        tried_residuals = problem.residuals(tried_theta, tried_starts, finer)
        gained = 0.0 if tried_residuals is None else _squares(now) - _squares(tried_residuals)
        if tried_residuals is not None and gained > 0.0:
            theta, starts, now, total_gain = tried_theta, tried_starts, tried_residuals, total_gain + gained
            damping = 0.1 * damping if damping > 1e-4 else 0.0
            slow_steps = slow_steps + 1 if gained < _GAIN * unit else 0
            if slow_steps == _SLOW:
                message = "settled"
                break
        elif total_gain == 0.0:
            damping = max(10.0 * damping, 1e-2)
            if damping > _DAMPED:
                message = "no smaller residual was found nearby"
                break
        if not total_gain or normal.damping or abs(gained - expected_gain) > _TRUSTED * expected_gain:
            normal = None
    if message != "settled" or normal is None or slow_steps == _SLOW:
        message = message or f"no end after {rounds} rounds"
        normal = _normal(problem, theta, starts, finer, _FINE)
    degrees_of_freedom = max(size - sum(x.size for x in starts) - len(problem.first), 1)
    identifiable = np.diag(normal.reduced) * reference_sizes(theta, problem.first) ** 2 > _FELT
    return MatchResult(theta, normal.covariance, identifiable, starts, now, degrees_of_freedom, message, normal, finer)


def _first(problem: Problem, values: FloatArray | None) -> FloatArray:
    """Return the starting parameters, with constant errors of 0."""
    if values is not None:
        return values.copy()
    shifts = 0 if problem.spread is None else int(np.count_nonzero(problem.spread > 0.0))
    return np.concatenate([problem.first, np.zeros(shifts)])


def _with_prior(problem: Problem, starts: list[FloatArray]) -> list[FloatArray]:
    """Return the window starts, with an empty one for the prior of constant errors if there are any."""
    count = len(problem.parts)
    return starts[:count] + ([] if problem.spread is None else [np.empty(0)])


def _refinement(parts: list[Window], law: Any) -> int:
    """Return the step refinement that makes integration errors negligible against standard errors."""
    refinement, coarse_residuals = 1, [segment.residual(law, segment.start, 1) for segment in parts]
    while refinement < _FINEST:
        fine_residuals = [segment.residual(law, segment.start, 2 * refinement) for segment in parts]
        if _squares([a - b for a, b in zip(coarse_residuals, fine_residuals, strict=True)]) <= _BLURRED**2:
            break
        refinement, coarse_residuals = 2 * refinement, fine_residuals
    return refinement


def _normal(
    problem: Problem, theta: FloatArray, starts: Sequence[FloatArray], *by: Any, damping: float = 0.0
) -> NormalEquations:
    return NormalEquations.of(problem.slopes(theta, starts, *by), len(theta), damping)


def reference_sizes(theta: FloatArray, first: FloatArray) -> FloatArray:
    """Return the reference sizes of parameters: |θ|, or the first value where θ is near 0."""
    sizes = np.abs(theta)
    is_pressed = (first > 0.0) & (theta[: len(first)] <= 2.0 * _LEAST * first)
    sizes[: len(first)][is_pressed] = first[is_pressed]
    return sizes


def _squares(found: list[FloatArray]) -> float:
    return float(sum(item @ item for item in found))


def _share(theta: FloatArray, moved: FloatArray, first: FloatArray) -> float:
    """Return the fraction of a step that keeps every positive parameter above a tenth of its value."""
    theta, moved = theta[: len(first)], moved[: len(first)]
    falls = (first > 0.0) & (moved < 0.0)
    step_limits = np.where(falls, (0.9 * theta - _LEAST * first) / np.where(falls, -moved, 1.0), np.inf)
    return float(min(1.0, np.maximum(step_limits, 1e-3).min(initial=1.0)))
