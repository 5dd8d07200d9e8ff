"""Second run of the same start, its difference, and reasons why a run may prove nothing.

The second run is a hundred times tighter, or looser where that cannot be; of a fixed step it is an adaptive one. By the
same method its steps are bounded by a part of the first's longest, so that the two share no stage; of a pair law given
by a formula also by what the formula's slopes ask for where pairs come by, so that it leaps over no feature.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from flockana.base import units
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import centres, lengths
from flockana.dynamics.error_tolerances import FINEST
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.dynamics.steps_between_samples import Between
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.beta_agents import InsideObstacleError
from flockana.solvers.solver_names import solvers
from flockana.theorems.step_resolution import demand_of, steps_of, unresolved

TIGHTER = 1e-2  # the second run's tolerances over the first's
DOUBT = 2.0  # times what two runs differ by: all of the error, if the tighter one's is at most half as large
RK4_SECOND = 1e-10  # relative tolerance of the second run of one with a fixed step
_SHARE = 0.618  # of the first run's longest step: the golden ratio, so that no number of steps brings stages together
_FINER = 0.5  # of the step that a formula asks for
_MOST_STEPS = 4096  # that a formula may ask of the second run, or _TIMES those of the first if these are more
_TIMES = 8
_MOST = 2**23  # numbers of the second run that are kept at the steps of the first
_LOOKED_AT = 9  # samples at which a run is asked whether it is in its law's domain
_LOW_ORDER = ("RK23", "RK45")  # methods that take many times the steps of DOP853 to a tight tolerance


class Errors(NamedTuple):
    """Half widths of positions and velocities relative to the centre, and of the centre, at some times."""

    t: FloatArray
    shape: FloatArray
    speed: FloatArray
    centre: FloatArray
    drift: FloatArray


class Pair(NamedTuple):
    """Two runs of one start at the same samples, their error half widths, and reasons for doubt."""

    tighter: Trajectory
    looser: Trajectory
    errors: Errors
    doubt: str = ""
    unresolved: str = ""
    enclosed: bool = False  # whether the orbit of a map is known in balls


def paired(run: Trajectory) -> Pair:
    """Return a flow's run with its second run; an unknown run is paired with itself."""
    doubt = doubt_about(run)
    if doubt:
        return Pair(run, run, unbounded_errors(run), doubt)
    steps, states = _common_steps(run)
    is_tight = "rtol" not in run.stats or TIGHTER * run.stats["rtol"] >= FINEST
    repeated_run = second_run(run, steps, TIGHTER if is_tight else 1.0 / TIGHTER, _longest_step(run))
    if repeated_run.status != "complete" or len(repeated_run.t) != len(steps):
        kind = "tighter" if is_tight else "looser"
        doubt = f"a {kind} second run ended at t = {repeated_run.t[-1]:.6g}: {repeated_run.message}"
        return Pair(run, run, unbounded_errors(run), doubt)
    thinned_run = _at_samples_of(repeated_run, run.t)
    first_run, second = (thinned_run, run) if is_tight else (run, thinned_run)
    position_error, speed, _ = second.floors
    errors = _errors(repeated_run, states)
    errors = Errors(errors.t, *map(np.maximum, errors[1:], (position_error, speed, position_error, speed)))
    return Pair(first_run, second, errors, unresolved=unresolved(repeated_run, position_error))


def _longest_step(run: Trajectory) -> float | None:
    """Return the longest step allowed in a repeated run; None without a limit."""
    steps, _ = steps_of(run)
    step_limit = max(_MOST_STEPS, _TIMES * len(steps))
    longest = max(_FINER * demand_of(run, run.floors.place).bound, float(steps.sum()) / step_limit)
    method, run_method = run.stats.get("method"), run.stats.get("max_step") or np.inf
    own_limit = np.inf if "rtol" not in run.stats or method in _LOW_ORDER else _SHARE * float(steps.max())
    bound = min(longest, own_limit, run_method)
    return bound if np.isfinite(bound) else None


def second_run(run: Trajectory, times: FloatArray, factor: float, longest: float | None) -> Trajectory:
    """Return the law integrated from the run's start at given times, with tolerances scaled by a factor."""
    # A run with a fixed step is followed by an adaptive method.
    stats, span = run.stats, (float(times[0]), float(times[-1]))
    options: dict[str, Any] = {"method": "DOP853", "rtol": RK4_SECOND}
    if "rtol" in stats:
        method = stats.get("method", "DOP853")
        if method in _LOW_ORDER or method not in solvers():
            method = "DOP853"
        options = {"method": method, "rtol": max(factor * stats["rtol"], FINEST)}
        options["atol"] = units.times(stats.get("atol"), factor)
    if longest is None:
        longest = stats.get("max_step")
    if longest is not None:
        options["max_step"] = longest
    # an interrupted one is no doubt about the first run
    return ensure_uninterrupted(simulate(run.law, run.q[0], run.p[0], span, t_eval=times, **options))


def doubt_about(run: Trajectory) -> str:
    """Return the reason why a run alone proves nothing, or an empty text."""
    if reason := failure(run):
        return reason
    return "one sample shows no motion" if len(run.t) == 1 else ""


def failure(run: Trajectory) -> str:
    """Return in words why a run failed or left the law's domain; empty for a valid run."""
    if run.status == "failed":
        return f"the run failed: {run.message}"
    if run.law.is_map:  # a step may lead anywhere
        return ""
    for k in np.unique(np.linspace(0, len(run.t) - 1, _LOOKED_AT).astype(int)):
        try:
            run.law.check_start(run.q[k], run.p[k])
        except ArgumentError as error:
            if k > 0 and isinstance(error, InsideObstacleError):  # theorems ask for that themselves
                continue
            return f"the run left the domain of its law before t = {run.t[k]:.6g}: {error}"
    return ""


def unbounded_errors(run: Trajectory) -> Errors:
    """Return infinite error half widths, for a run of unknown error."""
    unknown = np.full((1, run.n), np.inf)
    return Errors(run.t[:1], unknown, unknown, unknown[:, 0], unknown[:, 0])


def _common_steps(run: Trajectory) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Return the times at which a run is compared with its repetition, and its states at these times."""
    path = run.path
    stride = max(1, int(np.ceil(3.0 * path.q.size / _MOST)))
    is_kept = np.isin(path.t, run.t)
    is_kept[::stride] = True
    return path.t[is_kept], (path.q[is_kept], path.p[is_kept])


def _errors(again: Trajectory, states: tuple[FloatArray, FloatArray]) -> Errors:
    """Return error half widths from the difference of two runs at their common times."""
    differences = [(centred(x - y), centres(x - y)) for x, y in zip((again.q, again.p), states, strict=True)]
    (shape, centre), (speed, drift) = ((DOUBT * lengths(a), DOUBT * lengths(b)) for a, b in differences)
    return Errors(again.t, shape, speed, centre, drift)


def _at_samples_of(run: Trajectory, t: FloatArray) -> Trajectory:
    """Return a run at selected sample times, with all other samples kept as intermediate steps."""
    if len(t) == len(run.t):
        return run
    keep, path = np.isin(run.t, t), run.path
    is_between = ~np.isin(path.t, t)
    extra_series = {name: series[keep] for name, series in run.extra.items()}
    steps = Between(path.t[is_between], path.q[is_between], path.p[is_between], path.u[is_between], path.slack)
    return replace(run, t=run.t[keep], q=run.q[keep], p=run.p[keep], u=run.u[keep], extra=extra_series, between=steps)


def centred(x: FloatArray) -> FloatArray:
    """Return vectors of all agents less their mean, shape (T, n, m)."""
    return x - centres(x)[:, None]


def largest_over(values: FloatArray, first: Any, stop: Any) -> FloatArray:
    """Return the largest of the values with index from `first` to before `stop`, for each index range."""
    first, stop = np.asarray(first), np.minimum(stop, len(values))
    first = np.minimum(first, stop - 1)
    level = np.floor(np.log2(stop - first)).astype(int)
    largest, table, window = np.empty((len(first), *values.shape[1:])), values, 1
    for k in range(int(level.max(initial=0)) + 1):
        level_rows = np.flatnonzero(level == k)
        largest[level_rows] = np.maximum(table[first[level_rows]], table[stop[level_rows] - window])
        table = np.maximum(table[:-window], table[window:]) if len(table) > window else table
        window *= 2
    return largest
