"""Bounds on a flock between two samples, from the paths through the solver's own steps (`Trajectory.path`).

A distance between two agents of relative speed at most w and relative acceleration at most c exceeds what it is at the
nearer end by w h/2 at most in an interval h, and the larger of both ends by h²/8 of its second derivative, which is
w²/ℓ + c at most where the distance is ℓ. Control polygons of the paths bound speeds and accelerations on them, and the
allowance for the paths' own error (`flockana.kernels.paths`) is added.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.base.vectors import lengths
from flockana.dynamics.between import Course
from flockana.dynamics.trajectory import Trajectory
from flockana.kernels.paths import bernstein
from flockana.laws.discrete import DiscreteLaw
from flockana.measures.nets import LinkArray, components, link_lengths, links
from flockana.theorems.rounding import EPS


def _motion(run: Trajectory) -> FloatArray:
    """Largest ‖p_i − p_c‖ and ‖u_i − u_c‖ on the paths, and how far these may be off, shape (3, T − 1)."""
    path = run.path
    bounds = np.empty((3, len(path.t) - 1))
    for k, h in enumerate(np.diff(path.t).tolist()):
        ends = (x[k + side] for side in (0, 1) for x in (path.q, path.p, path.u))
        points, _, allowance = bernstein(h, *ends)
        legs = 5.0 / h * np.diff(points - points.mean(axis=0), axis=1)
        sizes = [lengths(x).max() for x in (legs, 4.0 / h * np.diff(legs, axis=1))]
        bounds[:, k] = *sizes, (allowance if path.slack is None else allowance + path.slack[k]).max()
    return run.over_intervals(np.maximum, bounds)


def fastest_between(run: Trajectory) -> FloatArray:
    """An upper bound of ‖p_i − p_c‖ over each interval between samples, of every agent, shape (T − 1,).

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> run = simulate(Algorithm1(), [[0.0], [99.0]], [[-1.0], [1.0]], (0.0, 1.0))
    >>> bool(abs(fastest_between(run).max() - 1.0) < 1e-12)
    True
    """
    fastest: FloatArray = _motion(run)[0]
    return fastest


def mismatch_between(run: Trajectory) -> FloatArray:
    """An upper bound of the normalised velocity mismatch K̃ over each interval between samples, shape (T − 1,).

    It is a convex function of velocities, and so at most what it is of the control points of the paths' velocities.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> run = simulate(Algorithm1(), [[0.0], [99.0]], [[-1.0], [1.0]], (0.0, 1.0))
    >>> bool(abs(mismatch_between(run).max() - 0.5) < 1e-12)
    True
    """
    if isinstance(run.law, DiscreteLaw):
        mismatch = run.metric("normalised_velocity_mismatch")
        ends: FloatArray = np.maximum(mismatch[:-1], mismatch[1:])
        return ends
    path, bounds = run.path, np.empty(len(run.path.t) - 1)
    for k, h in enumerate(np.diff(path.t).tolist()):
        points = bernstein(h, *(x[k + side] for side in (0, 1) for x in (path.q, path.p, path.u)))[0]
        legs = 5.0 / h * np.diff(points - points.mean(axis=0), axis=1)
        bounds[k] = 0.5 / run.n * np.sum(legs**2, axis=(0, 2)).max()
    if path.slack is not None:  # of steps that were not kept it is known where they went, and not how fast
        bounds[path.slack.max(axis=1) > 0.0] = np.inf
    between: FloatArray = run.over_intervals(np.maximum, bounds)
    return between


def stretch_between(run: Trajectory) -> FloatArray:
    """By how much any distance may leave the range of its values at both ends of each interval, shape (T − 1,).

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> run = simulate(Algorithm1(), [[0.0], [99.0]], [[-1.0], [1.0]], (0.0, 1.0))
    >>> bool(0.0 < stretch_between(run).max() <= 1.0)
    True
    """
    if isinstance(run.law, DiscreteLaw):
        return np.zeros(len(run.t) - 1)
    (speed, force, off), h, least = _motion(run), np.diff(run.t), run.metric("min_distance")
    low = np.maximum(np.minimum(least[:-1], least[1:]), np.finfo(float).tiny)
    with np.errstate(over="ignore"):
        stretch: FloatArray = _slack(low, low, h, 2.0 * speed, 2.0 * force) + 2.0 * off
    return stretch


def radius_between(run: Trajectory) -> FloatArray:
    """An upper bound of the cohesion radius over each interval between samples, shape (T − 1,).

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.dynamics.simulate import simulate
    >>> run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> bool(4.0 <= radius_between(run).max() < 4.0 + 1e-4)
    True
    """
    if isinstance(run.law, DiscreteLaw):
        radius = run.metric("cohesion_radius")
        ends: FloatArray = np.maximum(radius[:-1], radius[1:])
        return ends
    return run.cohesion_bounds


def spread_between(run: Trajectory) -> float:
    """An upper bound of √Σ‖q_i − q̄‖² on the paths, the samples included.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.cucker_smale import CuckerSmale
    >>> run = simulate(CuckerSmale(), [[0.0], [2.0]], [[1.0], [1.0]], (0.0, 1.0))
    >>> bool(abs(spread_between(run) - 2.0**0.5) < 1e-9)
    True
    """
    most = 0.0
    for points, off in _polygons(run):
        sizes = np.sqrt(np.sum((points - points.mean(axis=0)) ** 2, axis=(0, 2)))
        most = max(most, float(sizes.max() + np.linalg.norm(off)))
    return most


def least_between(run: Trajectory, i: Any, j: Any) -> float:
    """A lower bound of the distances of some pairs on the paths: of their control points along one direction.

    Parameters
    ----------
    run : Trajectory
        The run.
    i, j : int array
        The pairs, one at least.

    Examples
    --------
    Two agents that approach each other from afar:

    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> start = [[0.0], [99.0]], [[1.0], [-1.0]]
    >>> run = simulate(Algorithm1(), *start, (0.0, 9.0))
    >>> bool(81.0 - 1e-9 < least_between(run, [0], [1]) <= 81.0)
    True
    """
    least = np.inf
    for points, off in _polygons(run):
        apart = points[j] - points[i]
        ways = apart.mean(axis=1, keepdims=True)
        ways /= np.maximum(np.linalg.norm(ways, axis=2, keepdims=True), np.finfo(float).tiny)
        along = np.sum(apart * ways, axis=2).min(axis=1) - off[i] - off[j]
        least = min(least, float(along.min()))
    return max(least, 0.0)


def _polygons(run: Trajectory) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Control points of the agents' paths in each step, (n, 6, 3), and how far a path may be off each."""
    path = run.path
    for k, h in enumerate(np.diff(path.t).tolist()):
        points, _, allowance = bernstein(h, *(x[k + side] for side in (0, 1) for x in (path.q, path.p, path.u)))
        yield points, allowance if path.slack is None else allowance + path.slack[k]


@dataclass(frozen=True)
class Nets:
    """Bounds on the net at samples, or throughout the intervals between them; one number for each.

    Attributes
    ----------
    components, components_least : ndarray
        Number of components at most, and at least: without and with the pairs of which it is open.
    giant, giant_most : ndarray
        Agents in the largest component at least, and at most.
    links : ndarray
        Pairs that are linked for certain.
    open_links : ndarray
        Pairs of which it is open, at r but for rounding or for what they may do between samples.
    """

    components: FloatArray
    components_least: FloatArray
    giant: FloatArray
    giant_most: FloatArray
    links: FloatArray
    open_links: FloatArray


def nets_at(run: Trajectory) -> Nets:
    """The net at each sample of a run of a law with an α-interaction, but for rounding."""
    return run.remembered("nets at samples", lambda: _nets_at(run))


def _nets_at(run: Trajectory) -> Nets:
    r, rounding, rows = run.law.lattice[1], _rounding(run), []
    for k, q in enumerate(run.q):
        pairs = links(q, r + rounding)
        rows.append(_row(run, k, pairs, link_lengths(q, pairs) < r - rounding))
    return _nets(rows)


def nets_between(run: Trajectory) -> Nets:
    """The net in each interval between samples: what is nearer to r than the motion may bridge is left open."""
    return run.remembered("nets between samples", lambda: _nets_between(run))


def _nets_between(run: Trajectory) -> Nets:
    if isinstance(run.law, DiscreteLaw):
        return Nets(*(getattr(nets_at(run), field.name)[:-1] for field in fields(Nets)))
    r, rounding, rows = run.law.lattice[1], _rounding(run), []
    h, (speed, force, off), path = np.diff(run.t), _motion(run), run.path
    first = np.searchsorted(path.t, run.t)
    for k in range(len(run.t) - 1):
        error = 2.0 * float(off[k]) + rounding
        pairs = links(run.q[k], r + 4.0 * float(speed[k] * h[k]) + 2.0 * error)
        ends = np.stack([link_lengths(run.q[k], pairs), link_lengths(run.q[k + 1], pairs)])
        low, high = ends.min(axis=0), ends.max(axis=0)
        slack = _slack(low, r, h[k], 2.0 * speed[k], 2.0 * force[k]) + error
        if (unsure := (low - slack < r) & (high + slack >= r)).any():  # those two do not move as fast as the fastest
            own = _relative(path, range(first[k], first[k + 1]), pairs[unsure])
            slack[unsure] = np.minimum(slack[unsure], _slack(low[unsure], r, h[k], *own) + error)
        near = low - slack < r
        rows.append(_row(run, k, pairs[near], (high + slack < r)[near]))
    return _nets(rows)


def _slack(low: FloatArray, r: Any, h: Any, speed: Any, force: Any) -> FloatArray:
    """How far a distance, `low` at the nearer end, may go beyond its ends, at relative speeds and accelerations."""
    straight, bent = 0.5 * speed * h, h**2 / 8.0 * (2.0 * speed**2 / r + force)
    slack: FloatArray = np.where(low - straight >= 0.5 * r, np.minimum(straight, bent), straight)
    return slack


def _relative(path: Course, steps: range, pairs: LinkArray) -> tuple[FloatArray, FloatArray]:
    """Largest relative speed and acceleration of some pairs on their paths over some steps."""
    speed, force = np.zeros((2, len(pairs)))
    for k in steps:
        h = float(path.t[k + 1] - path.t[k])
        points = bernstein(h, *(x[k + side] for side in (0, 1) for x in (path.q, path.p, path.u)))[0]
        legs = 5.0 / h * np.diff(points[pairs[:, 1]] - points[pairs[:, 0]], axis=1)
        speed = np.maximum(speed, lengths(legs).max(axis=1))
        force = np.maximum(force, lengths(4.0 / h * np.diff(legs, axis=1)).max(axis=1))
    return speed, force


def _rounding(run: Trajectory) -> float:
    """Rounding of a distance of two agents, compared with r."""
    return float(16.0 * EPS * (np.abs(run.q).max() + run.law.lattice[1]))


def _row(run: Trajectory, k: int, pairs: LinkArray, certain: npt.NDArray[np.bool_]) -> tuple[float, ...]:
    """A row of `Nets` from the pairs that may be linked, and those among them that certainly are, near sample k."""
    count = int(certain.sum())
    if count == len(pairs):
        number = run.n - float(run.metric("connectivity")[k]) * (run.n - 1)
        giant = run.n * float(run.metric("giant_share")[k])
        return round(number), round(number), round(giant), round(giant), count, 0
    least, most = (np.bincount(components(run.n, linked)) for linked in (pairs[certain], pairs))
    return least.size, most.size, int(least.max()), int(most.max()), count, len(pairs) - count


def _nets(rows: list[tuple[float, ...]]) -> Nets:
    return Nets(*np.array(rows, dtype=np.float64).reshape(-1, 6).T)
