"""Parameters of a law fitted to a recording, with standard errors and what the data cannot determine."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, sqrt
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray, ensure_positive
from flockana.base.errors import ArgumentError, FlockanaError
from flockana.laws.discrete import ensure_law
from flockana.recorded.clustered import covariance_over_agents
from flockana.recorded.parameters import FreeParameters
from flockana.recorded.recording import Recording, ensure_recording
from flockana.recorded.shooting import MatchResult, matched, usual_window, windows
from flockana.recorded.steps import predicted

_LEVEL = 0.95
_UNKNOWN = 0.5  # relative standard error beyond which a parameter is not identifiable
_TIED = 0.99  # correlation of two parameters beyond which only one combination is identifiable
_FAR = 1e6  # residual of a law that cannot be
_SHORT = 0.25  # of the usual windows: these a search begins with
_NO_WORSE = 5.0  # standard deviations of the residuals' variance, within which two fits are as good
_LEAST = 1e-6  # of its first value, below which no positive parameter goes


@dataclass(frozen=True, eq=False)
class Fit:
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
        95 % confidence intervals.
    misfit : float
        Root mean square residual over the accuracy, 1 if the law fits within it; NaN where none is stated.
    freedom : float
        Degrees of freedom of the intervals.
    unidentifiable : tuple of str
        What the data cannot tell, in words.
    message : str
        How the search ended.
    """

    law: Any
    values: Mapping[str, float]
    errors: Mapping[str, float]
    correlation: FloatArray
    misfit: float
    freedom: float
    unidentifiable: tuple[str, ...]
    message: str = ""

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """95 % confidence intervals."""
        from scipy.stats import t

        width = float(t.ppf(0.5 * (1.0 + _LEVEL), max(self.freedom, 1)))
        return {k: (v - width * self.errors[k], v + width * self.errors[k]) for k, v in self.values.items()}

    def __str__(self) -> str:
        lines = [f"{self.law.title} fitted; residual {self.misfit:.3g} times the accuracy"]
        for name, (low, high) in self.intervals.items():
            lines.append(f"  {name} = {self.values[name]:.5g}, between {low:.5g} and {high:.5g} (95 %)")
        return "\n".join([*lines, *(f"  {text}" for text in self.unidentifiable)])


def fit(rec: Recording, law: Any, *, free: Sequence[str] | None = None, window: float | None = None) -> Fit:
    """Return the law with the parameters that best predict each sample from the one before.

    Where noise is stated (`sd`), or has to be estimated as only positions are known, solutions of the law are matched
    to windows of samples, each from a start of its own; standard errors count the starts, too. Where samples have
    velocities and no noise, the law is integrated from each sample to the next.

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
    ensure_recording(rec)
    own = ensure_law(law)
    if own.is_map:
        raise ArgumentError(f"{law.title} is a map: expected a continuous law, such as the one that it steps")
    own.check_dimension(rec.m)
    own.check_agents(rec.n)
    parameters = FreeParameters.of(law, free)
    if rec.p is None or (rec.sd is not None and np.max(rec.sd) > 0.0):
        return _matched(rec, parameters, window)
    return _stepped(rec, parameters)


def _matched(rec: Recording, parameters: FreeParameters, window: float | None) -> Fit:
    """Return the fit of solutions to windows of noisy positions."""
    if len(rec.t) < 4:
        raise ArgumentError(f"{len(rec.t)} samples: expected 4 or more of noisy positions")
    if window is None:
        found = _lengthened(rec, parameters)
    else:
        found = matched(windows(rec, ensure_positive("window", window)), parameters.with_values, parameters.values)
    variance = found.variance
    stated = rec.sd is not None and not rec.estimated
    covariance = found.covariance * (max(variance, 1.0) if stated else variance)
    return _result(parameters, found._replace(covariance=covariance), sqrt(variance) if stated else np.nan)


def _lengthened(rec: Recording, parameters: FreeParameters) -> MatchResult:
    """Return the solutions matched to the usual windows, from the parameters that short windows give.

    Long windows tell more of the parameters and have more false minima: where they fit worse than the short ones, the
    short ones count.
    """
    usual = usual_window(rec, parameters.law)
    short, long = windows(rec, _SHORT * usual), windows(rec, usual)
    found = matched(short, parameters.with_values, parameters.values)
    if len(long) == len(short):
        return found
    longer = matched(long, parameters.with_values, found.values)
    as_good = longer.variance <= found.variance * (1.0 + _NO_WORSE * sqrt(2.0 / found.freedom))
    return longer if as_good else found


def _stepped(rec: Recording, parameters: FreeParameters) -> Fit:
    """Return the fit of each sample predicted from the one before; standard errors from the spread over agents."""
    from scipy.optimize import least_squares

    rec.ensure_complete("a fit from sample to sample")
    if len(rec.t) < 2:
        raise ArgumentError("one sample: expected two or more to step between")
    assert rec.p is not None
    p, start = rec.p, parameters.values
    place, speed = (np.broadcast_to(each, rec.q.shape[:2])[1:] for each in (rec.accuracy.place, rec.accuracy.speed))
    stated = bool((place > 0.0).all() and np.isfinite(place).all() and (speed > 0.0).all())
    sizes = (place, speed) if stated else (np.diff(rec.t)[:, None], np.ones(1))
    unit = np.where(start == 0.0, 1.0, np.abs(start))

    def residual(z: FloatArray) -> FloatArray:
        try:
            q_next, p_next = predicted(parameters.with_values(z * unit), rec.t, rec.q, p, refine=2)
        except FlockanaError:
            return np.full(2 * (len(rec.t) - 1) * rec.n * rec.m, _FAR)
        off = rec.q[1:] - q_next, p[1:] - p_next
        return np.concatenate([(x / size[..., None]).ravel() for x, size in zip(off, sizes, strict=True)])

    low = np.where(start > 0.0, _LEAST, -inf)
    found: Any = least_squares(residual, start / unit, bounds=(low, inf), xtol=1e-10, ftol=1e-10, max_nfev=60)
    left = found.fun.reshape(2 * (len(rec.t) - 1), rec.n, rec.m)
    covariance, freedom = covariance_over_agents(found.jac.reshape(*left.shape, -1), left)
    covariance = covariance * np.outer(unit, unit)
    misfit = float(np.sqrt(np.mean(left**2))) if stated else np.nan
    told = np.abs(found.jac).max(axis=0) > 0.0
    best = MatchResult(found.x * unit, covariance, told, [], [found.fun], freedom, str(found.message))
    return _result(parameters, best, misfit)


def _result(parameters: FreeParameters, found: MatchResult, misfit: float) -> Fit:
    names, values = parameters.names, found.values
    errors = np.sqrt(np.maximum(np.diag(found.covariance), 0.0))
    scale = np.where(errors > 0.0, errors, 1.0)
    errors = np.where(found.identifiable, errors, inf)
    correlation = found.covariance / np.outer(scale, scale)
    given, known = (dict(zip(names, x.tolist(), strict=True)) for x in (values, errors))
    untold = [
        f"the data do not tell {name}: {value:.3g} ± {2.0 * error:.2g}"
        for name, value, error in zip(names, values, errors, strict=True)
        if error > _UNKNOWN * abs(value)
    ]
    untold += [
        f"the data tell {names[i]} and {names[j]} only together: correlation {correlation[i, j]:.4f}"
        for i, j in np.argwhere(np.triu(np.abs(correlation), 1) > _TIED)
    ]
    law = parameters.with_values(values)
    return Fit(law, given, known, correlation, misfit, found.freedom, tuple(untold), found.message)
