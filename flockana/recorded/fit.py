"""Parameters of a law fitted to a recording, with confidence intervals and notes on unidentifiable parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, sqrt
from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray, ensure_flag, ensure_positive
from flockana.laws.discrete import ensure_law
from flockana.recorded.compare import compare
from flockana.recorded.law_contributions import SYMBOLS
from flockana.recorded.law_parameters import FreeParameters
from flockana.recorded.likelihood_profiles import LowerMinimumError, profile_interval
from flockana.recorded.matching_windows import Window, deviations, rescaled, usual_window, windows
from flockana.recorded.recording import Recording, ensure_recording
from flockana.recorded.shooting import MatchResult, Problem, matched, reference_sizes

_LEVEL = 0.95
_OPEN = 10.0  # times a parameter's value, from which width of its interval on it is not identifiable
_SHORT = 0.25  # of the usual windows: these a search begins with
_NO_WORSE = 5.0  # standard deviations of the residuals' variance, within which two fits are as good
_CHANCE = 1e-3  # probability of a misfit by chance, below which it is reported
_ENOUGH = 20.0  # degrees of freedom from which the variance of residuals is an estimate
_SETTLED = 0.1  # relative change of deviations, below which they are estimated
_ROUNDS = 3  # in which deviations are estimated, and better minima are sought
_FACTORS = (1.0, 0.4, 2.5)  # of the first guess, at which searches begin where noise alone does not explain the misfit
_SHIFTED = 0.1  # of the deviation of an estimate, from which on a constant error counts


@dataclass(frozen=True, eq=False)
class Fit(ShortRepr):
    """A law fitted to a recording.

    Attributes
    ----------
    law : Law
        The law with the fitted parameters.
    values, errors : mapping of str to float
        The parameters and their standard errors.
    correlation : ndarray, shape (P, P)
        Of the estimates.
    intervals : mapping of str to (float, float)
        95 % confidence intervals, by the profile of the likelihood; infinite where it stays open.
    misfit : float
        Root mean square residual over the accuracy, 1 if the law fits within it; NaN where none is stated.
    freedom : float
        Degrees of freedom of the intervals.
    unidentifiable : tuple of str
        What the data cannot tell, in words: parameters whose interval is open, or ten times as wide as their value.
    doubts : tuple of str
        A misfit beyond chance, or another minimum that fits as well, in words; intervals are widened by both.
    message : str
        How the search ended.
    """

    law: Any
    values: Mapping[str, float]
    errors: Mapping[str, float]
    correlation: FloatArray
    misfit: float
    freedom: float
    intervals: Mapping[str, tuple[float, float]]
    unidentifiable: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    message: str = ""

    def __str__(self) -> str:
        size = f"{self.misfit:.3g} times the accuracy" if isfinite(self.misfit) else "as large as the noise, not stated"
        lines = [f"{self.law.title} fitted; residual {size}"]
        for name, (low, high) in self.intervals.items():
            lines.append(f"  {name} = {self.values[name]:.4g}, {interval_text(low, high)} (95 %)")
        return "\n".join([*lines, *(f"  {text}" for text in (*self.unidentifiable, *self.doubts))])


def interval_text(low: float, high: float) -> str:
    """Return an interval in words, open ends named, with enough digits to distinguish the ends.

    Examples
    --------
    >>> interval_text(1.99999992, 2.00000004), interval_text(0.0, inf)
    ('between 1.9999999 and 2', 'open')
    """
    if not isfinite(high):
        return "open" if not low > 0.0 else f"above {low:.4g}, open"
    if not isfinite(low):
        return f"below {high:.4g}, open"
    digits = next((k for k in range(4, 17) if f"{low:.{k}g}" != f"{high:.{k}g}"), 17)
    return f"between {low:.{digits}g} and {high:.{digits}g}"


def fit(
    rec: Recording,
    law: Any,
    *,
    free: Sequence[str] | None = None,
    window: float | None = None,
    independent: bool = False,
) -> Fit:
    """Return the law with the parameters that match a recording best, with 95 % intervals.

    Solutions of the law are matched to windows of samples, positions and recorded velocities, each from a start of its
    own, which is unknown, too. Searches begin at several places where the misfit is more than noise. Within a `bound`
    the variance of errors is estimated, and a constant error of each number is unknown, as far as the residuals leave
    room for it.

    Parameters
    ----------
    rec : Recording
        The recording.
    law : Law
        A continuous law, whose parameters are the first guess.
    free : sequence of str, optional
        Names of the parameters to fit, such as ``"c1_alpha"`` or ``"alpha.d"``; by default all gains.
    window : float, optional
        Duration of a window; by default eight times the law's time, and 40 samples at least; a quarter of that
        first, and in the end if longer windows fit worse.
    independent : bool
        Whether errors within the `bound` are independent of each other, with variance b²/3 at most.

    Raises
    ------
    ArgumentError
        On an unknown parameter, a law that is a map, or a recording that is too short.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.interactions import Gains
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.recorded.recording import recording_of
    >>> run = simulate(Algorithm1(gains=Gains(c1_alpha=20.0)), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> round(fit(recording_of(run), Algorithm1(), free=("c1_alpha",)).values["c1_alpha"], 4)
    20.0
    """
    rec = ensure_recording(rec).measured
    checked_law = ensure_law(law)
    ensure_flag("independent", independent)
    if checked_law.is_map:
        raise ArgumentError(f"{law.title} is a map: expected a continuous law, such as the one that it steps")
    checked_law.check_dimension(rec.m)
    checked_law.check_agents(rec.n)
    parameters = FreeParameters.of(law, free)
    if len(rec.t) < (4 if rec.p is None else 2):
        raise ArgumentError(f"{len(rec.t)} samples: expected 4 or more, or 2 with velocities")
    search = _Search(rec, parameters, None if window is None else ensure_positive("window", window))
    problem, best_match = _with_noise(search, independent)
    return _result(search, problem, best_match)


class _Search(NamedTuple):
    """Search for a law's parameters from a recording, in windows of a given duration."""

    rec: Recording
    parameters: FreeParameters
    window: float | None

    @property
    def stated(self) -> bool:
        """Whether the deviation of the noise is stated."""
        return self.rec.sd is not None and not self.rec.estimated and float(np.max(self.rec.sd)) > 0.0

    def problem(self, parts: list[Window]) -> Problem:
        """Return the least-squares problem of matching given windows by solutions of the law."""
        return Problem(parts, self.parameters.with_values, self.parameters.values)

    def is_chance(self, variance: float, freedom: float) -> bool:
        """Whether a residual variance is consistent with the noise, stated, bounded or estimated."""
        from scipy.stats import chi2

        return variance <= float(chi2.isf(_CHANCE, freedom)) / freedom


def _best_of(search: _Search, sd: FloatArray) -> tuple[Problem, MatchResult]:
    """Return the best fit of several searches, the first of which starts from the law's own parameters."""
    matches: list[tuple[Problem, MatchResult]] = []
    for begin in _beginnings(search):
        try:
            matches.append(_lengthened(search, sd, begin))
        except FlockanaError:
            continue
        if search.is_chance(matches[-1][1].variance, matches[-1][1].freedom):
            break
    if not matches:
        raise ArgumentError("the law cannot be integrated from the recorded starts: expected other first parameters")
    return min(matches, key=lambda each: each[1].variance)


def _beginnings(search: _Search) -> list[FloatArray]:
    """Return starting parameters: the law's, gains by regression on accelerations, and multiples of the law's."""
    values, names = search.parameters.values, search.parameters.names
    starts = [values * factor for factor in _FACTORS]
    try:
        shares = {share.symbol: share.found for share in compare(search.rec, search.parameters.law).shares}
    except FlockanaError:
        return starts
    guess = np.array([shares.get(SYMBOLS[x][0], v) if x in SYMBOLS else v for x, v in zip(names, values, strict=True)])
    is_usable = np.isfinite(guess) & ((guess > 0.0) | (values <= 0.0))
    return [starts[0], np.where(is_usable, guess, values), *starts[1:]]


def _lengthened(search: _Search, sd: FloatArray, begin: FloatArray) -> tuple[Problem, MatchResult]:
    """Return the fit over windows of the usual length, started from the parameters fitted to short windows.

    Long windows tell more of the parameters and have more false minima: where they fit worse than the short ones, the
    short ones count.
    """
    window_length = search.window or usual_window(search.rec, search.parameters.law)
    window_problem = search.problem(windows(search.rec, window_length, sd))
    if search.window is not None:
        return window_problem, matched(window_problem, values=begin)
    short = search.problem(windows(search.rec, _SHORT * window_length, sd))
    if len(window_problem.parts) == len(short.parts):
        return window_problem, matched(window_problem, values=begin)
    first_match = matched(short, values=begin)
    longer_match = matched(window_problem, values=first_match.values)
    is_as_good = longer_match.variance <= first_match.variance * (1.0 + _NO_WORSE * sqrt(2.0 / first_match.freedom))
    return (window_problem, longer_match) if is_as_good else (short, first_match)


def _with_noise(search: _Search, independent: bool) -> tuple[Problem, MatchResult]:
    """Return the fit with the stated noise, else with estimated deviations of positions and velocities."""
    rec = search.rec
    problem, best_match = _best_of(search, deviations(rec, velocities=True))
    if search.stated:
        return problem, best_match
    problem, best_match = _rescaled(problem, best_match, rec.n * rec.m)
    if rec.bound is None or independent:
        return problem, best_match
    spread = _spread(problem, best_match, rec)
    if not (spread > 0.0).any():
        return problem, best_match
    shifted_problem = Problem(problem.parts, problem.with_values, problem.first, spread)
    values = np.concatenate([best_match.values, np.zeros(int(np.count_nonzero(spread)))])
    return _rescaled(shifted_problem, matched(shifted_problem, starts=best_match.starts, values=values), rec.n * rec.m)


def _rescaled(problem: Problem, best: MatchResult, width: int) -> tuple[Problem, MatchResult]:
    """Return the fit with noise deviations of positions and velocities rescaled to its residuals."""
    for _ in range(_ROUNDS):
        factors = _factors(problem, best, width)
        if np.abs(np.log(factors)).max() < _SETTLED:
            break
        problem = replace(problem, parts=rescaled(problem.parts, factors))
        best = matched(problem, starts=best.starts, values=best.values)
    return problem, best


def _factors(problem: Problem, best: MatchResult, width: int) -> FloatArray:
    """Return the ratio of residuals to assumed noise deviations, of positions and velocities, by column."""
    parts = problem.parts
    factors, share = np.ones(parts[0].y.shape[1]), best.freedom / problem.size
    for block in (slice(0, width), slice(width, None)):
        count = sum(int(np.count_nonzero(segment.root[:, block])) for segment in parts)
        squares = sum(
            float(np.sum(r.reshape(segment.root.shape)[:, block] ** 2))
            for segment, r in zip(parts, best.residuals, strict=False)
        )
        if count * share >= _ENOUGH and squares > 0.0:
            factors[block] = sqrt(squares / (count * share))
    return factors


def _spread(problem: Problem, best: MatchResult, rec: Recording) -> FloatArray:
    """Return the standard deviation of each coordinate's constant error, within a bound left by the residuals.

    Errors of a number range over as much as its residuals; with a constant one all of them stay within the bound.
    """
    parts, shape = problem.parts, rec.present.shape
    limits = [np.broadcast_to(np.asarray(rec.bound, dtype=np.float64), shape).max(axis=0)]
    if rec.p is not None:
        speed = rec.bound / rec.interval if rec.p_bound is None else rec.p_bound
        limits.append(np.broadcast_to(np.asarray(speed, dtype=np.float64), shape).max(axis=0))
    bound = np.concatenate([np.repeat(x, rec.m) for x in limits])
    low, high = np.full(len(bound), inf), np.full(len(bound), -inf)
    for segment, residual in zip(parts, best.residuals, strict=False):
        is_used = segment.root > 0.0
        error = np.divide(residual.reshape(is_used.shape), segment.root, out=np.zeros(is_used.shape), where=is_used)
        low = np.minimum(low, np.where(is_used, error, inf).min(axis=0))
        high = np.maximum(high, np.where(is_used, error, -inf).max(axis=0))
    uncertainty = np.maximum(2.0 * bound - np.maximum(high - low, 0.0), 0.0) / sqrt(12.0)
    deviation = np.array([1.0 / max(float(segment.root.max()), 1e-300) for segment in parts]).min()
    count = sum(len(segment.t) for segment in parts)
    return np.where(uncertainty > _SHIFTED * deviation / sqrt(count), uncertainty, 0.0)


def _result(search: _Search, problem: Problem, best: MatchResult) -> Fit:
    """Return the fitted law with confidence intervals; refit if a likelihood profile finds a better minimum."""
    from scipy.stats import t as student

    names, count = search.parameters.names, len(problem.first)
    level, doubts = float(student.ppf(0.5 * (1.0 + _LEVEL), best.freedom)), list[str]()
    for _ in range(_ROUNDS):
        unit = max(best.variance, 1.0) if search.stated or best.freedom < _ENOUGH else best.variance
        try:
            parameter_bounds = [profile_interval(problem, best, k, level, unit) for k in range(count)]
            break
        except LowerMinimumError as lower:
            best = matched(problem, starts=lower.starts, values=lower.values, finer=best.finer)
    else:
        doubts.append("searches end at other minima: intervals are open")
        parameter_bounds = [(-inf, inf)] * count
    if search.stated and not search.is_chance(best.variance, best.freedom):
        doubts.append(
            f"residuals are {sqrt(best.variance):.3g} times the stated noise, beyond chance: does the law act?"
        )
    values, covariance = best.values[:count], best.covariance[:count, :count] * unit
    errors = np.where(best.identifiable[:count], np.sqrt(np.maximum(np.diag(covariance), 0.0)), inf)
    scale = np.where(np.isfinite(errors) & (errors > 0.0), errors, 1.0)
    open_remarks = [
        f"the data do not tell {name}: {value:.4g}, {interval_text(*end)}"
        for name, value, size, end in zip(
            names, values, reference_sizes(values, problem.first), parameter_bounds, strict=True
        )
        if not isfinite(end[1] - end[0]) or end[1] - end[0] > _OPEN * size
    ]
    return Fit(
        search.parameters.with_values(values),
        dict(zip(names, values.tolist(), strict=True)),
        dict(zip(names, errors.tolist(), strict=True)),
        covariance / np.outer(scale, scale),
        sqrt(best.variance) if search.rec.bound is not None or search.stated else np.nan,
        best.freedom,
        dict(zip(names, parameter_bounds, strict=True)),
        tuple(open_remarks),
        tuple(doubts),
        best.message,
    )
