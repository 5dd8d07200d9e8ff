"""Work and precision: what each method needs for each tolerance, and how far off it then is."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from benchmarks.rows import Asked, Found, Row
from benchmarks.runs import methods, peer
from benchmarks.timing import seconds_of
from flockana.base.value_checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.scenarios import scenario

STUDY = "Work and precision, Fig. 10"
TOLERANCES = tuple(10.0**-k for k in range(4, 13))
STEPS = (0.04, 0.02, 0.01, 0.005, 0.0025)
FINEST = 1e-13  # of the reference
_TODAY = (
    "Scipy steps the law as it is now, whose evaluations take the same time in both; the bound was asked of the code "
    "of before, which has a table of its own."
)
LONGEST = 5.0  # seconds of a run, from which on a method is not asked for more
SAMPLES = 61


def study(*, quick: bool) -> Found:
    """Every method at nine tolerances, and RK4 at five steps; every third of them where a few minutes must do."""
    case = scenario("paper-flocking")
    reference = run(case, {"rtol": FINEST}).q
    lines = [(name, "rtol", TOLERANCES[:: 3 if quick else 1]) for name in methods()]
    lines.append(("RK4", "dt", STEPS[:: 2 if quick else 1]))
    series, notices = list[dict[str, Any]](), list[str]()
    for method, knob, settings in lines:
        for setting in settings:
            options = {"method": method, knob: setting}
            made = run(case, options)
            error = way_off(made.q, reference, case.law.alpha.d) if made.status == "complete" else np.inf
            seconds = seconds_of(partial(run, case, options))
            series.append({"method": method, knob: setting, "error": error, "seconds": seconds})
            if seconds > LONGEST and setting != settings[-1]:
                notices.append(
                    f"{method} below {knob} {setting:g}: a run takes {seconds:.0f} s, and more from there on"
                )
                break
    for point, seconds in zip(series, _in_turns(case, series, rounds=0 if quick else 2), strict=True):
        point["seconds"] = float(np.median([point["seconds"], *seconds]))
    return Found([_row(point) for point in series] + at_equal_error(series), notices, {"work-precision": series})


def _in_turns(case: Any, series: list[dict[str, Any]], *, rounds: int) -> list[list[float]]:
    """CPU seconds of further runs of each, all of them once in every round."""
    calls = [partial(run, case, {k: v for k, v in point.items() if k in ("method", "rtol", "dt")}) for point in series]
    taken = [[seconds_of(call) for call in calls] for _ in range(rounds)]
    return [[one[k] for one in taken] for k in range(len(series))]


def at_equal_error(series: list[dict[str, Any]]) -> list[Row]:
    """Each compiled method against solve_ivp's under the same law.

    Parameters
    ----------
    series : list of dict
        Method, error and seconds of each run.
    """
    rows = []
    for method in methods():
        other = peer(method)
        taken, gains = faster_at_equal_error(series, method, other) if other else (np.empty(0), np.empty(0))
        if gains.size:
            name, worst = (
                f"{method} at equal error: times faster, median of {gains.size}",
                f"at least {gains.min():.3g}",
            )
            asked = Asked(">=", 10.0, why=_TODAY) if method == "DOP853" else None
            value = 1e3 * float(np.median(taken))
            rows.append(Row(STUDY, name, 150, value, "ms", str(other), float(np.median(gains)), asked, worst))
    return rows


def faster_at_equal_error(series: list[dict[str, Any]], method: str, other: str) -> tuple[FloatArray, FloatArray]:
    """(seconds that a method takes, on its own line, for the errors that another made; how many times faster it is).

    Parameters
    ----------
    series : list of dict
        Method, error and seconds of each run.
    method, other : str
        Which two.
    """
    ours, theirs = (
        np.array(sorted((p["error"], p["seconds"]) for p in series if p["method"] == name and p["error"] < np.inf))
        .reshape(-1, 2)
        .T
        for name in (method, other)
    )
    if not ours.size:
        return np.empty(0), np.empty(0)
    reached = (theirs[0] >= ours[0, 0]) & (theirs[0] <= ours[0, -1])
    taken = np.exp(np.interp(np.log(theirs[0, reached]), *np.log(ours)))
    return taken, theirs[1, reached] / taken


def run(case: Any, options: dict[str, Any]) -> Any:
    """The figure's run, kept at so many times."""
    times = np.linspace(*case.t_span, SAMPLES)
    return simulate(case.law, case.q0, case.p0, case.t_span, t_eval=times, **options)


def way_off(q: FloatArray, reference: FloatArray, d: float) -> float:
    """The farthest that any agent is, at any sample, from where the reference has it, in units of d."""
    return float(np.linalg.norm(q - reference, axis=2).max() / d)


def _row(point: dict[str, Any]) -> Row:
    knob = "rtol" if "rtol" in point else "dt"
    name = f"{point['method']}, {knob} {point[knob]:g}"
    return Row(STUDY, name, 150, 1e3 * point["seconds"], "ms", note=f"farthest off by {point['error']:.2g} d")
