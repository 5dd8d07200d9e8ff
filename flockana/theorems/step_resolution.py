"""Whether a run's steps resolve a pair law given by a formula: no feature may hide between the stages of a step.

The slopes of force and adjacency are bounded on parts of the range (`FormulaInteraction.slopes`). Over the distances
that a pair goes through in a step h let ω² = 2 (c1 |F'| + c2 |a'| ‖p_j − p_i‖), and ℓ the way that their distance goes.
What hides in the step then moves the two by at most (hω)² ℓ. A step with hω <= 2 resolves the law: a feature of width
w < ℓ changes velocities by at most the share 4 (w/ℓ)². So does a step that hides less than the run's own error.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.vectors import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.interactions import FormulaInteraction
from flockana.kernels.neighbours import pair_blocks
from flockana.kernels.paths import control_points

NAME = "the steps resolve the law"
RESOLVED = 2.0  # hω, up to which a step resolves the law
_PARTS = 64  # of the range


class Formula(NamedTuple):
    """Pair law of a term by its formula, with the gains of force and consensus."""

    pair: FormulaInteraction
    stiffness: float
    damping: float


class NeededSteps(NamedTuple):
    """Steps that contain each interval of a run's path, and the longest ones that would resolve the law there."""

    t: FloatArray
    step: FloatArray
    longest: FloatArray

    @property
    def missed(self) -> Any:
        """Intervals whose steps are too long; 1e-9 of a step is rounding of its ends."""
        return np.flatnonzero(self.step > self.longest * (1.0 + 1e-9))

    @property
    def bound(self) -> float:
        """Step that would resolve the law wherever its slopes are known; infinite if all steps do."""
        asked = self.longest[self.missed]
        return float(asked[asked > 0.0].min(initial=np.inf))


def formulas_of(law: Any) -> tuple[Formula, ...]:
    """Return the pair laws among a law's terms that are given by a formula."""
    found = ((getattr(term, "pair", None), term) for term in getattr(law, "terms", ()))
    return tuple(
        Formula(pair, float(getattr(term, "stiffness", 0.0)), float(term.damping))
        for pair, term in found
        if isinstance(pair, FormulaInteraction)
    )


def demand_of(run: Trajectory, place: float) -> NeededSteps:
    """Return the steps of a run with the longest ones that its pair laws' slopes allow, positions known to an error."""
    t, q, p, u, slack = run.path
    step, longest = steps_of(run)[1], np.full(len(t) - 1, np.inf)
    for formula in formulas_of(run.law):
        for k in range(len(t) - 1):
            points, reach, allowance = control_points(t[k + 1] - t[k], q[k], p[k], u[k], q[k + 1], p[k + 1], u[k + 1])
            if slack is not None:
                reach, allowance = reach + slack[k], allowance + slack[k]
            for i, j in pair_blocks(q[k], formula.pair.range + 2.0 * float(reach.max())):
                rate, way = _hidden(formula, points[j] - points[i], allowance[i] + allowance[j], t[k + 1] - t[k])
                way = way * step[k] / (t[k + 1] - t[k])
                hides = rate * step[k] ** 2 * way > place
                worst = float(rate.max(where=hides, initial=0.0))
                longest[k] = min(longest[k], RESOLVED / np.sqrt(worst) if worst > 0.0 else np.inf)
    return NeededSteps(t, step, longest)


def steps_of(run: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Return the lengths of a run's steps, and of the step that contains each interval of its path."""
    if run.between is not None:
        ends = np.concatenate([run.t[:1], run.between.t, run.t[-1:]])
    else:  # as many samples as steps, or all samples within one step
        ends = run.t if run.stats.get("steps", 0) >= len(run.t) - 1 else run.t[[0, -1]]
    steps = np.diff(ends)
    at = np.clip(np.searchsorted(ends, run.path.t[:-1], side="right") - 1, 0, len(steps) - 1)
    return steps, steps[at]


def _hidden(formula: Formula, apart: FloatArray, allowance: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
    """Return ω² of each pair over an interval, from its relative control points, and how far its distance moves."""
    sides, ends = lengths(np.diff(apart, axis=1)).sum(axis=1) + 2.0 * allowance, lengths(apart[:, [0, -1]])
    middle, edges = 0.5 * ends.sum(axis=1), _table(formula.pair)[0]
    first = np.clip(np.searchsorted(edges, middle - 0.5 * sides, side="right") - 1, 0, len(edges) - 2)
    last = np.clip(np.searchsorted(edges, middle + 0.5 * sides, side="left") - 1, first, len(edges) - 2)
    force, weight = (most[first, last] for most in _table(formula.pair)[1:])
    speed = 2.0 * sides / time
    with np.errstate(invalid="ignore"):  # an unknown slope without a gain or a motion moves nothing
        parts = np.nan_to_num([formula.stiffness * force, formula.damping * weight * speed], nan=0.0, posinf=np.inf)
    out = middle - 0.5 * sides >= formula.pair.range
    return np.where(out, 0.0, 2.0 * parts.sum(axis=0)), sides


@lru_cache(maxsize=64)
def _table(pair: FormulaInteraction) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return edges of parts of the range, and the largest slopes of force and adjacency from part to part."""
    bounds = pair.slopes(_PARTS)
    edges = np.array([*(bound.left for bound in bounds), bounds[-1].right])
    return edges, _from_to([bound.force for bound in bounds]), _from_to([bound.adjacency for bound in bounds])


def _from_to(values: list[float]) -> FloatArray:
    """Return the largest of some values from the row's index to the column's."""
    rows = [np.maximum.accumulate(np.where(np.arange(len(values)) < k, 0.0, values)) for k in range(len(values))]
    return np.array(rows)


def unresolved(run: Trajectory, place: float) -> str:
    """Return where a run's steps may leap over a feature of its pair law, in words; empty if they resolve it."""
    if not formulas_of(run.law):
        return ""
    found = demand_of(run, place)
    if not (missed := found.missed).size:
        return ""
    k = int(missed[np.argmin(found.longest[missed])])
    where = f"at t = {found.t[k]:.4g} a pair is at distances where"
    if found.longest[k] == 0.0:
        return f"{where} the slope of the pair law has no bound"
    return f"{where} the pair law asks for steps of {found.longest[k]:.2g} at most; the step is {found.step[k]:.2g}"
