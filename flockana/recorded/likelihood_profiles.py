"""Confidence intervals from the profile likelihood: one parameter fixed, all others fitted again."""

from math import inf, sqrt

import numpy as np

from flockana.base.errors import FlockanaError
from flockana.base.value_checks import FloatArray
from flockana.recorded.shooting import MatchResult, Problem, matched

_FINE = 0.1  # of the law's time, over which slopes are carried by one linearisation
_FEW = 15  # rounds of a match with a parameter fixed, which begins close to its end
_CLOSE = 0.05  # relative error of an end of an interval
_TRIALS = 12  # fixed values that are tried for an end
_FARTHEST = 1e3  # times its value or standard error, beyond which a parameter is open
_LOWER = 0.5  # squared deviations by which a profile may fall below the minimum


class LowerMinimumError(Exception):
    """Raised when a likelihood profile finds a better fit; holds its parameter values and window starts."""

    def __init__(self, result: MatchResult, k: int, value: float) -> None:
        self.values = np.insert(result.values, k, value)
        self.starts = result.starts


def profile_interval(problem: Problem, best: MatchResult, k: int, level: float, unit: float) -> tuple[float, float]:
    """Return the parameter values at which the squared residuals rise by level² above their minimum.

    An end is infinite, or 0 for a positive parameter, if they do not. Raises `LowerMinimumError` where they fall.
    """
    error = sqrt(max(float(best.covariance[k, k]), 0.0) * unit)
    if not best.identifiable[k] or error == 0.0:
        return -inf if problem.first[k] <= 0.0 else 0.0, inf
    return _end(problem, best, k, -1.0, level, unit, error), _end(problem, best, k, 1.0, level, unit, error)


def _end(problem: Problem, best: MatchResult, k: int, side: float, level: float, unit: float, error: float) -> float:
    value, is_positive = float(best.values[k]), problem.first[k] > 0.0
    floor = 1e-6 * problem.first[k] if is_positive else -inf
    farthest = _FARTHEST * max(abs(value), error)
    inside, outside, off, last = 0.0, inf, level * error, _Trial(0.0, best.values, best.starts)
    for number in range(_TRIALS):
        at = max(value + side * off, floor)
        trial = _rise(problem, best, k, at, last, known=number == 0)
        height = inf if trial is None else sqrt(max(trial.rise / unit, 0.0))
        if trial is not None and trial.rise < -_LOWER * unit:
            raise LowerMinimumError(trial.result, k, at)
        if abs(height - level) <= _CLOSE * level:
            return at
        reach = abs(at - value)
        if height < level:
            if at == floor:
                return 0.0
            inside, last = reach, trial or last
        else:
            outside = reach
        if inside >= farthest:
            return side * inf
        guess = (
            reach * level / height if 0.0 < height < inf else 4.0 * reach if height == 0.0 else 0.5 * (inside + reach)
        )
        guess = min(max(guess, reach / 4.0), 4.0 * reach)
        off = guess if inside < guess < outside else 0.5 * (inside + outside) if outside < inf else 4.0 * inside
    return value + side * (outside if outside < inf else inf)


class _Trial:
    """Fit with one parameter fixed: its parameter values and window starts, and the rise of squared residuals."""

    def __init__(self, rise: float, values: FloatArray, starts: list[FloatArray], result: MatchResult | None = None):
        self.rise, self.values, self.starts = rise, values, starts
        self._result = result

    @property
    def result(self) -> MatchResult:
        assert self._result is not None
        return self._result


def _rise(problem: Problem, best: MatchResult, k: int, at: float, last: _Trial, *, known: bool) -> _Trial | None:
    """Return the fit with a parameter fixed, started on a line from the last fit; None without a fit.

    Slopes are at first those of the best fit, if these are `known` to serve.
    """
    value_change, normal = at - float(last.values[k]), best.normal
    other_indices = np.delete(np.arange(len(best.values)), k)
    direction = np.zeros(len(best.values))
    direction[k] = 1.0
    if other_indices.size:
        block = normal.reduced[np.ix_(other_indices, other_indices)]
        direction[other_indices] = -np.linalg.lstsq(block, normal.reduced[other_indices, k], rcond=1e-12)[0]
    values = last.values + value_change * direction
    count = len(problem.first)
    low = np.where(problem.first > 0.0, 0.1 * last.values[:count], -inf)
    values[:count] = np.maximum(values[:count], low)
    starts = [
        x - corner @ (cross_blocks @ (value_change * direction)) if x.size else x
        for x, corner, cross_blocks in zip(last.starts, normal.corners, normal.across, strict=True)
    ]
    fixed_problem = problem.fixed(k, at)
    for begin in (starts, last.starts):
        try:
            result = matched(
                fixed_problem,
                starts=begin,
                values=np.delete(values, k),
                finer=best.finer,
                block=_FINE,
                rounds=_FEW,
                normal=normal.without(k) if known else None,
            )
        except FlockanaError:
            continue
        return _Trial(result.squares - best.squares, np.insert(result.values, k, at), result.starts, result)
    return None
