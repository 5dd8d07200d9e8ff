"""Clearances of runs from obstacles, between samples too, and distances from constrained α-lattices.

Between two samples a path is the quintic that matches position, velocity and acceleration at both ends; in Bernstein
form it stays in the convex hull of its control points. The signed distance from a convex solid is convex, so it lies
above its tangent plane at any point: over the hull that plane is least at a control point, which bounds the clearance
from below. Halving an interval makes the bound as tight as one likes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any, NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_points
from flockana.base.vector_norms import lengths
from flockana.environment.beta_agents import ObstacleField
from flockana.environment.obstacles import Obstacle
from flockana.interactions import AlphaInteraction, BetaInteraction
from flockana.kernels.quintic_paths import bernstein
from flockana.measures.nets import link_lengths, links

RELATIVE_TOL = 1e-9  # of the halving, relative to the extent of the motion
ROUNDING = 2.0**-50  # of the coordinates
_DEPTH = 40  # halvings: below any resolved motion
_MOST = 100_000  # parts open at once; beyond it the bound is not tightened further
_CHUNK = 50_000  # agent-intervals handled at once


@dataclass(frozen=True, eq=False)
class Clearance:
    """Least clearance of a run from its obstacles."""

    # lower bound of every agent's signed distance from every obstacle at every time, given the integrator's accuracy
    # and steps that resolve the motion (`flockana.kernels.quintic_paths`); ∞ without obstacles
    lower: float
    reached: float  # least signed distance reached on the interpolated paths: an estimate from above
    time: float  # when it was reached
    agent: int  # agent, obstacle: by which agent, at which obstacle; -1 without obstacles
    obstacle: int
    lower_by_obstacle: FloatArray  # shape (K,): the lower bound for each obstacle


def clearance(
    t: FloatArray,
    q: FloatArray,
    p: FloatArray,
    u: FloatArray,
    obstacles: Sequence[Obstacle],
    slack: FloatArray | None = None,
) -> Clearance:
    """Bound the clearance of all agents from all obstacles over all times, from samples of a run."""
    # The bound subtracts an allowance for each path's own error (`flockana.kernels.quintic_paths`), so it is weak
    # where samples are too sparse to resolve the motion.
    n, m = q.shape[1:]
    minima = [_Minimum(t, _least_clearances(obstacle, q.reshape(-1, m)).reshape(len(t), n)) for obstacle in obstacles]
    extent, rows = float(np.ptp(q.reshape(-1, m), axis=0).max()), max(1, _CHUNK // n)
    tol = max(RELATIVE_TOL * extent, ROUNDING * float(np.abs(q).max()))
    for start_index in range(0, len(t) - 1 if obstacles else 0, rows):
        part = slice(start_index, min(start_index + rows, len(t) - 1))
        next_rows = slice(part.start + 1, part.stop + 1)
        h = (t[next_rows] - t[part])[:, None, None]
        segment_ends = (x.reshape(-1, m) for k in (part, next_rows) for x in (q[k], h * p[k], h * h * u[k]))
        curves, reach, path_error = (x.reshape(-1, n, *x.shape[1:]) for x in bernstein(1.0, *segment_ends))
        points, slack_part = curves[..., :m], 0.0 if slack is None else slack[part]
        for obstacle, clearances in zip(obstacles, minima, strict=True):
            row, agent = np.nonzero(clearances.at_samples[part] - (reach + slack_part) < clearances.lower)
            path_offsets = points[row, agent] - points[row, agent, 5:]  # from their last points fewer get so far
            back_lengths = np.sqrt(np.einsum("kxm,kxm->kx", path_offsets, path_offsets).max(axis=1, initial=0.0))
            allowance = (path_error + slack_part)[row, agent]
            near = clearances.at_samples[next_rows][row, agent] - (back_lengths + allowance) < clearances.lower
            row, agent = row[near], agent[near]
            bound = refine(obstacle, points[row, agent], allowance[near], clearances.lower, tol)
            clearances.update(bound, t, row + part.start, agent)
    k = min(range(len(minima)), key=lambda each: minima[each].reached, default=-1)
    bounds = np.array([clearances.lower for clearances in minima])
    if k < 0:
        return Clearance(inf, inf, float(t[0]), -1, -1, bounds)
    return Clearance(float(bounds.min()), minima[k].reached, minima[k].time, minima[k].agent, k, bounds)


def _least_clearances(obstacle: Obstacle, points: FloatArray) -> FloatArray:
    """Return points' signed distances to an obstacle, exact where one may be least, lower bounds elsewhere."""
    centre, radius = obstacle.ball
    offsets = points - centre
    distance: FloatArray = np.sqrt(np.einsum("km,km->k", offsets, offsets)) - radius
    distance -= 4.0 * ROUNDING * (np.abs(points).max() + np.abs(centre).max() + (radius if radius < inf else 0.0))
    best_clearance = obstacle.clearance(points[np.argmin(distance)][None])[0]
    is_candidate = distance <= best_clearance
    distance[is_candidate] = obstacle.clearance(points[is_candidate])
    return distance


class _CurveMinimum(NamedTuple):
    """Least clearance over curves: lower bound, least known value, and the curve and parameter where it occurs."""

    lower: float
    value: float
    parameter: float
    curve: int


class _Minimum:
    """Running minimum of the clearance from one obstacle, at first that of the samples."""

    def __init__(self, t: FloatArray, at_samples: FloatArray) -> None:
        k, self.agent = divmod(int(np.argmin(at_samples)), at_samples.shape[1])
        self.at_samples, self.time = at_samples, float(t[k])
        self.lower = self.reached = float(at_samples[k, self.agent])

    def update(self, bound: _CurveMinimum, t: FloatArray, interval: Any, agent: Any) -> None:
        """Update the least clearance and its lower bound from a bound on agents' curves between samples."""
        self.lower = min(self.lower, bound.lower)
        if bound.value < self.reached:
            k, self.agent = int(interval[bound.curve]), int(agent[bound.curve])
            self.reached, self.time = bound.value, float(t[k] + bound.parameter * (t[k + 1] - t[k]))


def refine(obstacle: Obstacle, curves: FloatArray, allowance: FloatArray, best: float, tol: float) -> _CurveMinimum:
    """Return bounds of the least clearance along curves by bisection; the lower one is `best` if none is lower."""
    proven_bound, value, best_time, curve_number = best, inf, 0.0, -1
    curve_indices, start, width = np.arange(len(curves)), np.zeros(len(curves)), 1.0
    for depth in range(_DEPTH):
        if not len(curves):
            break
        left, right = _halves(curves)
        midpoints = np.ascontiguousarray(left[:, 5])
        gaps, bound = bounds_over_hull(obstacle, curves, midpoints, tol)
        bound -= allowance
        lowest_index = int(np.argmin(gaps))
        if gaps[lowest_index] < value:
            value, curve_number = float(gaps[lowest_index]), int(curve_indices[lowest_index])
            best_time = float(start[lowest_index]) + 0.5 * width
        # on the paths, without their allowance, an open part may still hold a point lower than any seen
        is_open = (bound < proven_bound) & (bound + allowance < min(value, best) - tol)
        if depth == _DEPTH - 1 or np.count_nonzero(is_open) > _MOST:
            is_open[:] = False  # their bounds hold as they are
        proven_bound = min(proven_bound, float(bound[~is_open].min(initial=inf)))
        curves, allowance = np.concatenate([left[is_open], right[is_open]]), np.tile(allowance[is_open], 2)
        start = np.concatenate([start[is_open], start[is_open] + 0.5 * width])
        curve_indices, width = np.tile(curve_indices[is_open], 2), 0.5 * width
    return _CurveMinimum(proven_bound, value, best_time, curve_number)


def bounds_over_hull(
    obstacle: Obstacle, curves: FloatArray, middle: FloatArray, tol: float
) -> tuple[FloatArray, FloatArray]:
    """Return the signed distance at a point of each curve's convex hull, and a lower bound over the whole hull."""
    gap, _, distance = obstacle._project(middle, np.zeros_like(middle))
    hull = curves - middle[:, None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        outward_normal = -gap / distance[:, None]  # the gradient of the signed distance, inside too
    plane = np.einsum("km,kcm->kc", outward_normal, hull).min(axis=1)
    plane[~np.isfinite(plane) | (np.abs(distance) <= tol)] = -inf  # no direction there: only the distance bounds
    return distance, distance + np.maximum(plane, -lengths(hull).max(axis=1))


def _halves(curves: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the control points of both halves of every curve (de Casteljau)."""
    levels = [curves]
    for _ in range(5):
        levels.append(0.5 * (levels[-1][:, :-1] + levels[-1][:, 1:]))
    left = np.stack([level[:, 0] for level in levels], axis=1)
    right = np.stack([level[:, -1] for level in reversed(levels)], axis=1)
    return left, right


@dataclass(frozen=True)
class ConstrainedLattice:
    """Distance of a configuration from a constrained α-lattice: links of length d, β-agents at d'."""

    alpha_error: float  # largest |‖q_j − q_i‖ − d| over links; NaN without links
    beta_error: float  # largest |‖q̂_ik − q_i‖ − d'| over β-neighbours (within r'); NaN without any
    links: int  # links, beta_links: how many there are of each
    beta_links: int


def constrained_lattice(
    q: Any, obstacles: Sequence[Obstacle], *, alpha: AlphaInteraction, beta: BetaInteraction
) -> ConstrainedLattice:
    """Measure a configuration against a constrained α-lattice (Olfati-Saber 2006)."""
    # The repulsion ends at d' but N_i^β at r': an agent between the two is a neighbour that nothing pulls to d'.
    q = ensure_points("q", q)
    excess = np.abs(link_lengths(q, links(q, alpha.r)) - alpha.d)
    slack = np.abs(ObstacleField(tuple(obstacles), beta).links(q, np.zeros_like(q)).distance - beta.d)
    alpha_error, beta_error = (float(x.max()) if x.size else float("nan") for x in (excess, slack))
    return ConstrainedLattice(alpha_error, beta_error, excess.size, slack.size)
