"""Closest approach, contacts and cohesion radius along sampled paths, bounded between samples.

What is bounded are the motions themselves, given the integrator's accuracy at the samples, wherever the samples resolve
them (`flockana.kernels.quintic_paths` says when that is): those of the solver's own steps do, samples of one's own
choice need not. So a run keeps the steps between its samples (`flockana.dynamics.steps_between_samples`).
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.kernels import quintic_paths
from flockana.kernels.neighbours import DENSE_MAX, pair_blocks
from flockana.measures.metrics import cohesion_radii, min_distances

States = tuple[FloatArray, FloatArray, FloatArray]  # q, p, u over time

ROUNDING = 2.0**-50  # of the coordinates: a smaller distance is lost in their rounding and counts as 0
RELATIVE_TOL = 1e-6  # of the subdivision: far below the interpolation allowance of any real run


@dataclass(frozen=True, eq=False)
class ClosestApproach:
    """Closest approach of two agents over a run."""

    # lower bound of every pair's distance at every time of the run, given the integrator's accuracy and samples that
    # resolve the motion
    lower: float
    distance: float  # distance that was reached on the interpolated path: an estimate from above
    time: float  # when
    pair: tuple[int, int]  # which two agents; (-1, -1) if there is but one
    lower_by_interval: FloatArray  # shape (T - 1,): the lower bound for each interval between samples


def closest_approach(
    t: FloatArray, q: FloatArray, p: FloatArray, u: FloatArray, slack: FloatArray | None = None
) -> ClosestApproach:
    """Return lower bounds of all pair distances over all times, from samples of position, velocity, acceleration."""
    # Paths are quintic between samples; the bound subtracts an allowance for each path's own error, so it is weak where
    # samples are too sparse to resolve the motion.
    if q.shape[1] == 1:
        return ClosestApproach(np.inf, np.inf, float(t[0]), (-1, -1), np.full(len(t) - 1, np.inf))
    sample_distances = min_distances(q)
    extents = np.maximum(q.max(axis=(1, 2)), -q.min(axis=(1, 2)))  # |q| would be another run's memory
    k = int(np.argmin(sample_distances))
    lower = least_distance = float(sample_distances[k])
    when, pair = float(t[k]), _pair_at(q[k], least_distance)
    stops, noises = np.minimum(sample_distances[:-1], sample_distances[1:]), ROUNDING * extents[:-1]
    bounds = np.where(stops > noises, stops, 0.0)
    if len(bounds) and bounds.min() == 0.0:
        lower = 0.0
    slack = np.zeros((len(bounds), q.shape[1])) if slack is None else slack
    for k, low, distance, at, a, b in _nearer(t, (q, p, u), slack, bounds.copy(), noises):
        bounds[k] = low
        if low < lower:
            share = at if at >= 0.0 else float(sample_distances[k + 1] < sample_distances[k])  # nowhere below both ends
            lower, when, pair = low, float(t[k] + share * (t[k + 1] - t[k])), (int(min(a, b)), int(max(a, b)))
        least_distance = min(least_distance, distance)
    return ClosestApproach(lower, least_distance, when, pair, bounds)


def _nearer(t: FloatArray, states: States, slack: FloatArray, stops: FloatArray, noises: FloatArray) -> Iterator[Any]:
    """Yield (interval, lower bound, distance, fraction, i, j) where a pair may be nearer than at interval ends."""
    q, p, u = (np.ascontiguousarray(x) for x in states)
    if q.shape[1] <= DENSE_MAX:  # a loop over intervals in Python would take ten times as long
        tols = np.maximum(RELATIVE_TOL * stops, noises)
        approach = quintic_paths.closest_of_few(t, (q, p, u), slack, stops, tols)
        near_intervals = np.flatnonzero(approach[3] >= 0)
        yield from zip(near_intervals.tolist(), *(item[near_intervals].tolist() for item in approach), strict=True)
        return
    for k in np.flatnonzero(stops).tolist():
        points, reach, allowance = quintic_paths.control_points(
            t[k + 1] - t[k], q[k], p[k], u[k], q[k + 1], p[k + 1], u[k + 1]
        )
        reach, allowance, stop = reach + slack[k], allowance + slack[k], float(stops[k])
        for i, j in pair_blocks(q[k], (stop + 2.0 * float(reach.max())) * (1.0 + 1e-9)):
            tol = max(RELATIVE_TOL * stop, noises[k])
            low, distance, closest_time, a, b = quintic_paths.closest_pair(points, reach, allowance, i, j, stop, tol)
            if a >= 0:
                stop = low
                yield k, low, distance, closest_time, a, b


def _pair_at(q: FloatArray, distance: float) -> tuple[int, int]:
    """Return two agents (i, j) at the given least distance of a configuration; (−1, −1) without such a pair."""
    for i, j in pair_blocks(q, np.nextafter(distance * (1.0 + 1e-12), np.inf)):
        if i.size:
            return int(min(i[0], j[0])), int(max(i[0], j[0]))
    return -1, -1


def cohesion_bound(
    t: FloatArray, q: FloatArray, p: FloatArray, u: FloatArray, slack: FloatArray | None = None
) -> FloatArray:
    """Return an upper bound of the cohesion radius max_i ‖q_i − q_c‖ over each interval between samples."""
    radii, extents = cohesion_radii(q), np.maximum(q.max(axis=(1, 2)), -q.min(axis=(1, 2)))
    floors, noises = np.maximum(radii[:-1], radii[1:]), ROUNDING * np.maximum(extents[:-1], extents[1:])
    slack = np.zeros((len(floors), q.shape[1])) if slack is None else slack
    states = tuple(np.ascontiguousarray(x) for x in (q, p, u))
    return quintic_paths.farthest_in_turn(t, states, slack, floors, np.maximum(RELATIVE_TOL * floors, noises))


@dataclass(frozen=True)
class Contact:
    """Pair of agents within the contact tolerance, with the time of contact."""

    i: int  # i, j: the agents, i < j
    j: int
    time: float  # first time at which they are within the tolerance
    crossed: bool  # true if their order on the line changed between two samples (m = 1): then they certainly met


def contacts(
    t: FloatArray, q: FloatArray, p: FloatArray, u: FloatArray, *, tol: float, intervals: Iterable[int] | None = None
) -> tuple[Contact, ...]:
    """Return the pairs that come within `tol` of each other, with their first times, in order of time."""
    # Only in the intervals given, in rising order, if it is known that none comes so near in the others.
    first_contacts: dict[tuple[int, int], Contact] = {}
    for k in range(len(t) - 1) if intervals is None else intervals:
        h = t[k + 1] - t[k]
        points, reach, _ = quintic_paths.control_points(h, q[k], p[k], u[k], q[k + 1], p[k + 1], u[k + 1])
        for i, j in pair_blocks(q[k], tol + 2.0 * float(reach.max())):
            contact_times = np.empty(i.size)
            quintic_paths.touching_pairs(points, reach, i, j, tol, contact_times)
            hit = contact_times >= 0.0
            i, j, shares = i[hit], j[hit], contact_times[hit].tolist()
            for a, b, share in zip(np.minimum(i, j).tolist(), np.maximum(i, j).tolist(), shares, strict=True):
                if (a, b) not in first_contacts:
                    start_gap, end_gap = q[k, b] - q[k, a], q[k + 1, b] - q[k + 1, a]
                    has_crossed = q.shape[2] == 1 and bool(start_gap[0] * end_gap[0] < 0.0)
                    first_contacts[a, b] = Contact(a, b, float(t[k] + share * h), has_crossed)
    return tuple(sorted(first_contacts.values(), key=lambda c: (c.time, c.i, c.j)))
