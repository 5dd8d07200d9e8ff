"""Checks of the γ-agent during a run: rest, and agreement with its declared motion.

A target that has a closed form says what it is (`flockana.environment.target`). Of any other one the difference of its
positions over each interval between samples is compared with the integral of what it declares, each half of the
solver's steps being such an interval. What differs is unmet. What does not is assumed, as a function cannot be seen
everywhere, unless its user states how slowly it changes and it was seen more often than that.
"""

from collections.abc import Callable
from math import sqrt

import numpy as np

from flockana.environment.target import Target
from flockana.theorems.theorem import HypothesisStatus
from flockana.theorems.theorem_toolkit import EPS, FloatArray, Hypothesis, Trajectory

_NODES = np.array([-sqrt(0.6), 0.0, sqrt(0.6)])  # Gauss-Legendre, exact up to degree five
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
_CONSISTENT = 1e-6  # of the law's speed: what a source's own rounding of a velocity may amount to
_PER_FEATURE = 4.0  # times in the shortest time in which a function changes, by its user's statement
_MOST_TIMES = 100_000


def has_closed_path(target: Target) -> bool:
    """Return whether a γ-agent's path is known to be the sum of a line and an oscillation."""
    return target.consistent is not None and target.closed_path is not None


def _sample_times(run: Trajectory) -> FloatArray:
    """Return the times at which the γ-agent is sampled."""
    target = run.law.target
    if has_closed_path(target) or len(run.t) < 2:
        return run.t
    steps = run.path.t
    times = np.unique(np.concatenate([steps, 0.5 * (steps[:-1] + steps[1:])]))  # a jump is two samples at one time
    count = min((times[-1] - times[0]) * _PER_FEATURE / (target.feature or np.inf), _MOST_TIMES)
    return np.union1d(times, np.linspace(times[0], times[-1], int(np.ceil(count)) + 1))


def _seen_everywhere(run: Trajectory, times: FloatArray) -> bool:
    """Return whether the γ-agent's motion has no features hidden between the times it is sampled at."""
    target = run.law.target
    has_feature = target.feature is not None and len(times) > 1
    return has_closed_path(target) or bool(
        has_feature and np.diff(times).max() <= 1.001 * target.feature / _PER_FEATURE
    )


def _between(t: FloatArray) -> FloatArray:
    """Return Gauss quadrature times in both halves of every interval, shape (T − 1, 2, 3)."""
    midpoints, half_width = 0.5 * (t[:-1] + t[1:]), 0.25 * np.diff(t)
    halves = np.stack([midpoints - half_width, midpoints + half_width], axis=1)
    return halves[:, :, None] + half_width[:, None, None] * _NODES


def target_rests(run: Trajectory, *, any_p_r: bool) -> Hypothesis:
    """Return the hypothesis that the γ-agent rests in the whole run, with p_r = 0 (or constant with `any_p_r`)."""
    target, at = run.law.target, _sample_times(run)
    times = np.concatenate([at, _between(at).ravel()])
    states = [target.state(float(time)) for time in times]
    q_r, p_r = (np.array(series) for series in zip(*states, strict=True))
    speed = run.scales.speed
    way, change = float(np.abs(q_r - q_r[0]).max()), float(np.abs(p_r - (p_r[0] if any_p_r else 0.0)).max())
    moves = (
        (has_closed_path(target) and not target.constant_velocity)
        or way > 4.0 * EPS * float(np.abs(q_r).max())
        or change > 4.0 * EPS * max(float(np.abs(p_r).max()), speed)
    )
    status: HypothesisStatus = "unmet" if moves else "met" if _seen_everywhere(run, at) else "assumed"
    return Hypothesis(
        "the γ-agent is static" if any_p_r else "the γ-agent is at rest, p_r = 0",
        status,
        -max(way / run.scales.length, change / speed),
        _describe_rest(moves, any_p_r, p_r[0]) + ("" if status != "assumed" else f", as seen at {times.size} times"),
        decided="exact" if moves or has_closed_path(target) else "assumed",
    )


def _describe_rest(moves: bool, any_p_r: bool, p_r: FloatArray) -> str:
    if moves:
        outside_text = "it moves, which is outside the theorem"
        return outside_text if any_p_r else "it moves, or reports a velocity: it does work on the flock, of either sign"
    printed_remark = " though q_r does not move, as printed" if p_r.any() else ""
    return f"q_r is fixed, p_r = {p_r.tolist()}{printed_remark}"


def slip(run: Trajectory, velocity: Callable[[float], FloatArray]) -> tuple[float, float]:
    """Return the largest difference of a declared velocity from the γ-agent's motion, and its error."""
    target, t = run.law.target, _sample_times(run)
    h = np.diff(t)
    if h.size == 0:
        return 0.0, float("inf")
    q_r = np.array([target.state(float(time))[0] for time in t])
    nodes = _between(t)
    coarse_times = (0.5 * (t[:-1] + t[1:]))[:, None] + 0.5 * h[:, None] * _NODES
    fine_means, rough_means = _mean(velocity, nodes).mean(axis=1), _mean(velocity, coarse_times)
    deviation = np.linalg.norm(np.diff(q_r, axis=0) / h[:, None] - fine_means, axis=1)
    rounding = 4.0 * EPS * np.abs(q_r).max() / h + 8.0 * EPS * np.abs(fine_means).max()
    error = np.linalg.norm(fine_means - rough_means, axis=1) + rounding
    worst = int(np.argmax(deviation - error))
    return float(deviation[worst]), float(error[worst])


def _mean(velocity: Callable[[float], FloatArray], nodes: FloatArray) -> FloatArray:
    """Return the mean of a velocity over intervals from its Gauss nodes on the last axis."""
    values = np.array([velocity(float(time)) for time in nodes.ravel()]).reshape(*nodes.shape, -1)
    return np.einsum("...kc,k->...c", values, _WEIGHTS)


def consistent(run: Trajectory) -> Hypothesis:
    """Return the hypothesis dq_r/dt = p_r: the γ-agent's reported velocity is true."""
    name, fact = "dq_r/dt = p_r", run.law.target.consistent
    agreement = _agrees(run, name, "p_r", lambda t: run.law.target.state(t)[1])
    if fact is None or (fact is False and agreement.status == "unmet"):
        return agreement
    detail = "by the closed form of its path" if fact else "p_r is another velocity, by the closed form of its path"
    return Hypothesis(name, "met" if fact else "unmet", agreement.margin, detail, agreement.error)


def declared_rate_is_true(run: Trajectory) -> Hypothesis:
    """Return the hypothesis that the target's declared rate is the derivative of its positions."""
    name, target = "the γ-agent's declared rate is dq_r/dt", run.law.target
    if target.consistent is not None:
        return Hypothesis(name, "met", detail="by the closed form of its path")
    return _agrees(run, name, "the rate", target.rate)


def _agrees(run: Trajectory, name: str, what: str, velocity: Callable[[float], FloatArray]) -> Hypothesis:
    (deviation, error), slip_limit = slip(run, velocity), _CONSISTENT * run.scales.speed
    if deviation + error <= slip_limit:
        times = _sample_times(run)
        if _seen_everywhere(run, times):
            return Hypothesis(name, "met", -deviation, "as its user states how slowly it changes", error, "assumed")
        detail = f"so at {times.size} times; nobody states how slowly it changes (changes_slower_than)"
        return Hypothesis(name, "assumed", -deviation, detail, error)
    if deviation - error <= slip_limit:
        return Hypothesis(name, "assumed", -deviation, "the samples are too sparse to decide", error)
    return Hypothesis(name, "unmet", -deviation, f"{what} is off by up to {deviation:.3g}", error, decided="enclosed")
