"""Resolution check: whether a run's steps resolve the narrowest features of its law.

A law names the narrowest features of its parts (`law.features()`), through wrappers: lengths that no agent or pair may
leap over within a step, and times that no step may exceed. Where a function of the distance has slopes, these decide,
unless its feature does. Over the distances that a pair goes through in a step h let ω² = 2 (c1 |F'| + c2 |a'| ‖p_j −
p_i‖), and ℓ the way that their distance goes. What hides in the step then moves the two by at most (hω)² ℓ. A step with
hω <= 2 resolves the law: a feature of width w < ℓ changes velocities by at most the share 4 (w/ℓ)². So does a step that
hides less than the run's own error. A part that does not say what it reads is not resolved by any step.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.interactions.distance_functions import DistanceFunction, LawFunction
from flockana.kernels.neighbours import pair_blocks
from flockana.kernels.quintic_paths import control_points
from flockana.laws.law_features import Feature

NAME = "the steps resolve the law"
RESOLVED = 2.0  # hω, up to which a step resolves the law
_PARTS = 64  # of the range
_FEW, _BLOCK = 40, 20_000  # agents of which all pairs are looked at, and pairs at once


class NeededSteps(NamedTuple):
    """Actual step of each interval of a run's path, and the longest step that resolves the law."""

    t: FloatArray
    step: FloatArray
    longest: FloatArray
    part: Any  # (T − 1,) place in `law.features()` of the part that asks for it

    @property
    def missed(self) -> Any:
        """Indices of the intervals whose steps are too long to resolve the law."""
        return np.flatnonzero(self.step > self.longest * (1.0 + 1e-9))

    @property
    def bound(self) -> float:
        """Longest step that resolves all known features of the law; infinite if every step of the run does."""
        steps_missed = self.longest[self.missed]
        return float(steps_missed[steps_missed > 0.0].min(initial=np.inf))


def unknown_parts(law: Any) -> tuple[str, ...]:
    """Return the names of a law's parts with undeclared functions or unknown feature widths."""
    return tuple(dict.fromkeys(one.name for one in law.features() if one.width is None and not _has_slopes(one)))


def _has_slopes(feature: Feature) -> bool:
    function = None if feature.function is None else feature.function.function
    return function is not None and type(function).slopes is not DistanceFunction.slopes


def demand_of(run: Trajectory, place: float) -> NeededSteps:
    """Return the steps of a run with the longest steps allowed by its law's features."""
    t, step = run.path.t, steps_of(run)[1]
    longest, part = np.full(len(t) - 1, np.inf), np.zeros(len(t) - 1, dtype=np.int64)
    for number, feature in enumerate(run.law.features()):
        if feature.of == "time":
            step_limits = np.full(len(step), np.inf if feature.width is None else feature.width)
        else:
            step_limits = _allowed_by_lengths(run, feature, step, place)
        part, longest = np.where(step_limits < longest, number, part), np.minimum(longest, step_limits)
    return NeededSteps(t, step, longest, part)


def _allowed_by_lengths(run: Trajectory, feature: Feature, step: FloatArray, place: float) -> FloatArray:
    """Return the longest step over each interval allowed by a feature between agents."""
    path_lengths = _largest_speeds(run, pairs=feature.of == "pairs") * step
    width = 0.0 if feature.width is None else feature.width
    step_limits = np.full(len(step), np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        short = np.where(path_lengths > width, step * width / path_lengths, np.inf)
    if not _has_slopes(feature):
        return short if feature.width is not None else step_limits
    assert feature.function is not None  # it has slopes
    fast_pairs = np.flatnonzero(path_lengths > width)
    rates = _in_blocks if feature.function.edges is not None or len(run.q[0]) <= _FEW else _one_by_one
    worst = rates(run, feature.function, fast_pairs, step, place)
    limited_rows = fast_pairs[worst > 0.0]
    step_limits[limited_rows] = np.maximum(RESOLVED / np.sqrt(worst[worst > 0.0]), short[limited_rows])
    return step_limits


def _largest_speeds(run: Trajectory, *, pairs: bool) -> FloatArray:
    """Return a bound of the speeds of agents over each interval of a run's path, or of the relative speeds of two."""
    p = run.path.p - run.path.p.mean(axis=1, keepdims=True) if pairs else run.path.p
    speed = lengths(p).max(axis=1, initial=0.0) * (2.0 if pairs else 1.0)
    return np.maximum(speed[1:], speed[:-1])


def _one_by_one(run: Trajectory, function: LawFunction, at: Any, step: FloatArray, place: float) -> FloatArray:
    """Return over each interval the largest ω² of pairs that may hide more than the position error in a step."""
    assert function.function is not None
    worst, span = np.zeros(len(at)), np.diff(run.path.t)
    for row, k in enumerate(at.tolist()):
        points, reach, allowance = _control_points(run, k)
        near = function.function.range + 2.0 * float(reach.max())
        for i, j in pair_blocks(run.path.q[k], near) if np.isfinite(near) else [np.triu_indices(len(reach), 1)]:
            displacement, off = points[j] - points[i], allowance[i] + allowance[j]
            worst[row] = max(worst[row], _largest(function, displacement, off, span[k], step[k], place, len(reach)))
    return worst


def _in_blocks(run: Trajectory, function: LawFunction, at: Any, step: FloatArray, place: float) -> FloatArray:
    """Return the largest ω² of pairs with hidden motion, for few pairs over many intervals at once."""
    n, span, worst = len(run.q[0]), np.diff(run.path.t), np.zeros(len(at))
    i, j = np.triu_indices(n, 1) if function.edges is None else np.array(function.edges, dtype=np.intp).reshape(-1, 2).T
    block_length = max(1, _BLOCK // max(1, len(i)))
    for start_index in range(0, len(at) if len(i) else 0, block_length):
        rows = at[start_index : start_index + block_length]
        entries = [_control_points(run, k) for k in rows.tolist()]
        points, allowance = np.array([entry[0] for entry in entries]), np.array([entry[2] for entry in entries])
        time, step_lengths = span[rows, None], step[rows, None]
        worst[start_index : start_index + block_length] = _largest(
            function, points[:, j] - points[:, i], allowance[:, i] + allowance[:, j], time, step_lengths, place, n
        )
    return worst


def _largest(
    of: LawFunction, apart: FloatArray, off: FloatArray, span: Any, step: Any, place: float, n: int
) -> FloatArray:
    """Return the largest squared rate ω² of pairs whose hidden motion exceeds a given distance."""
    rate, hidden_path = _hidden(of, apart, off, span)
    rate = rate / n if of.mean else rate
    hidden_distance = rate * step * step * (hidden_path * step / span)
    return np.asarray(rate.max(axis=-1, where=hidden_distance > place, initial=0.0))


def _control_points(run: Trajectory, k: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return Bézier control points of the agents' paths in an interval, their reaches and error bounds."""
    t, q, p, u, slack = run.path
    points, reach, allowance = control_points(t[k + 1] - t[k], q[k], p[k], u[k], q[k + 1], p[k + 1], u[k + 1])
    return (points, reach, allowance) if slack is None else (points, reach + slack[k], allowance + slack[k])


def steps_of(run: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Return the lengths of a run's steps, and of the step that contains each interval of its path."""
    if run.between is not None:
        step_times = np.concatenate([run.t[:1], run.between.t, run.t[-1:]])
    else:  # as many samples as steps, or all samples within one step
        step_times = run.t if run.stats.get("steps", 0) >= len(run.t) - 1 else run.t[[0, -1]]
    steps = np.diff(step_times)
    step_indices = np.clip(np.searchsorted(step_times, run.path.t[:-1], side="right") - 1, 0, len(steps) - 1)
    return steps, steps[step_indices]


def _hidden(of: LawFunction, apart: FloatArray, allowance: FloatArray, time: Any) -> tuple[FloatArray, FloatArray]:
    """Return the squared rate ω² of each pair over an interval, and the change of its distance."""
    assert of.function is not None
    sides, ends = lengths(np.diff(apart, axis=-2)).sum(axis=-1) + 2.0 * allowance, lengths(apart[..., [0, -1], :])
    midpoints, table = 0.5 * ends.sum(axis=-1), _table(of.function)
    edges = table[0]
    first_cells = np.clip(np.searchsorted(edges, midpoints - 0.5 * sides, side="right") - 1, 0, len(edges) - 2)
    last_cells = np.clip(np.searchsorted(edges, midpoints + 0.5 * sides, side="left") - 1, first_cells, len(edges) - 2)
    force, adjacency = (maxima[first_cells, last_cells] for maxima in table[1:])
    speed = 2.0 * sides / time
    with np.errstate(invalid="ignore"):  # an unknown slope without a gain or a motion moves nothing
        parts = np.nan_to_num([of.stiffness * force, of.damping * adjacency * speed], nan=0.0, posinf=np.inf)
    is_outside = midpoints - 0.5 * sides >= of.function.range
    return np.where(is_outside, 0.0, 2.0 * parts.sum(axis=0)), sides


@lru_cache(maxsize=64)
def _table(function: DistanceFunction) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return edges of distance intervals, and largest slopes of force and adjacency between any two."""
    bounds = function.slopes(_PARTS)
    assert bounds is not None
    edges = np.array([*(bound.left for bound in bounds), bounds[-1].right])
    return edges, _from_to([bound.force for bound in bounds]), _from_to([bound.adjacency for bound in bounds])


def _from_to(values: list[float]) -> FloatArray:
    """Return a matrix of the largest of some values between each row's and each column's index."""
    rows = [np.maximum.accumulate(np.where(np.arange(len(values)) < k, 0.0, values)) for k in range(len(values))]
    return np.array(rows)


def unresolved(run: Trajectory, place: float) -> str:
    """Return in words where a run's steps may skip a feature of its law; empty if resolved."""
    law: Any = run.law
    if unknown := unknown_parts(law):
        return f"how fast {unknown[0]} changes is not known, and so whether steps resolve it"
    demand = demand_of(run, place)
    if not (missed := demand.missed).size:
        return ""
    k = int(missed[np.argmin(demand.longest[missed])])
    feature = law.features()[demand.part[k]]
    where = f"at t = {demand.t[k]:.4g} a pair is at distances where"
    if feature.of == "time":
        where = "at all times"
    elif not _has_slopes(feature):
        where = f"at t = {demand.t[k]:.4g}"
    if demand.longest[k] == 0.0:
        return f"{where} the slope of {feature.name} has no bound"
    return f"{where} {feature.name} asks for steps of {demand.longest[k]:.2g} at most; the step is {demand.step[k]:.2g}"
