"""Bounds on a flock between two samples, from the paths through the solver's own steps (`Trajectory.path`).

A distance between two agents of relative speed at most w and relative acceleration at most c exceeds what it is at the
nearer end by w h/2 at most in an interval h, and the larger of both ends by h²/8 of its second derivative, which is
w²/ℓ + c at most where the distance is ℓ. Control polygons of the paths bound speeds and accelerations on them, and the
allowance for the paths' own error (`flockana.kernels.quintic_paths`) is added.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.kernels.quintic_paths import bernstein
from flockana.measures.nets import LinkArray, components, link_lengths, links
from flockana.theorems.theorem_toolkit import EPS, Enclosure, FloatArray, Observed, Trajectory, lengths, stacked


def _motion(seen: Observed) -> FloatArray:
    """Return the largest ‖p_i − p_c‖ and ‖u_i − u_c‖ on the paths, and the paths' error, shape (3, T − 1)."""
    bounds = []
    for h, points, path_error in polygons(seen.run):
        legs = _legs(h, points - points.mean(axis=0))
        bounds.append([lengths(legs).max(), lengths(4.0 / h * np.diff(legs, axis=1)).max(), path_error.max()])
    motion = seen.run.over_intervals(np.maximum, np.reshape(bounds, (-1, 3)).T)
    motion[0] += seen.between_speed_error
    motion[2] += seen.between_error
    return motion


def fastest_between(seen: Observed) -> FloatArray:
    """Return an upper bound of ‖p_i − p_c‖ over each interval between samples, shape (T − 1,)."""
    return _motion(seen)[0]


def mismatch_over(seen: Observed) -> Enclosure:
    """Return the largest normalised velocity mismatch K̃ over each interval between samples, shape (T − 1,).

    Between samples it is bounded by its values at the control points of the velocities, as it is convex.
    """

    def bound() -> FloatArray:
        squares = (_legs(h, points - points.mean(axis=0)) ** 2 for h, points, _ in polygons(seen.run))
        sizes, slack = np.array([np.sqrt(np.sum(square, axis=(0, 2)).max()) for square in squares]), seen.run.path.slack
        if slack is not None:  # of steps that were not kept it is known where they went, and not how fast
            sizes[slack.max(axis=1) > 0.0] = np.inf
        magnitude: FloatArray = seen.run.over_intervals(np.maximum, sizes) + np.sqrt(seen.n) * seen.between_speed_error
        return magnitude**2 / (2.0 * seen.n)

    return _over(seen, seen.mismatch, bound)


def stretch_between(seen: Observed) -> FloatArray:
    """Return bounds of how far distances may leave the range of their end values, shape (T − 1,)."""
    if seen.is_map:
        return np.zeros(len(seen.t) - 1)
    (speed, force, path_error), h, min_distance = _motion(seen), np.diff(seen.t), seen.run.metric("min_distance")
    low = np.maximum(np.minimum(min_distance[:-1], min_distance[1:]), np.finfo(float).tiny)
    with np.errstate(over="ignore"):
        stretch: FloatArray = _slack(low, low, h, 2.0 * speed, 2.0 * force) + 2.0 * path_error
    return stretch


def radius_over(seen: Observed) -> Enclosure:
    """Return the largest cohesion radius over each interval between samples, shape (T − 1,)."""
    return _over(seen, seen.radius, lambda: seen.run.cohesion_bounds + seen.between_error)


def spread_over(seen: Observed) -> Enclosure:
    """Return the largest √Σ‖q_i − q_c‖² over each interval between samples, shape (T − 1,)."""

    def bound() -> FloatArray:
        steps = ((points - points.mean(axis=0), path_error) for _, points, path_error in polygons(seen.run))
        magnitudes = [np.sqrt(np.sum(x**2, axis=(0, 2))).max() + np.linalg.norm(path_error) for x, path_error in steps]
        return seen.run.over_intervals(np.maximum, np.array(magnitudes)) + np.sqrt(seen.n) * seen.between_error

    return _over(seen, seen.spread, bound)


def _over(seen: Observed, at_samples: Enclosure, bound: Callable[[], FloatArray]) -> Enclosure:
    """Return an enclosure of a quantity's largest value over each interval between samples."""
    if len(seen.t) == 1:
        return at_samples
    ends = stacked([at_samples[:-1], at_samples[1:]]).max(axis=0)
    return ends if seen.is_map else Enclosure(ends.lo, ends.mid, np.maximum(ends.hi, bound()))


def least_distance(seen: Observed, i: Any, j: Any) -> Enclosure:
    """Return an enclosure of the least distance of given pairs over the run, also between samples."""
    sample_distances = seen.distances(i, j).min()
    if seen.is_map or len(seen.t) == 1:
        return sample_distances
    distances = []
    for _, points, path_error in polygons(seen.run):
        displacement = points[j] - points[i]
        directions = displacement.mean(axis=1, keepdims=True)
        directions /= np.maximum(np.linalg.norm(directions, axis=2, keepdims=True), np.finfo(float).tiny)
        distances.append((np.sum(displacement * directions, axis=2).min(axis=1) - path_error[i] - path_error[j]).min())
    interval_distances = seen.run.over_intervals(np.minimum, np.array(distances)) - 2.0 * seen.between_error
    low = max(min(float(interval_distances.min()), float(sample_distances.lo)), 0.0)
    return Enclosure(low, sample_distances.mid, sample_distances.hi)


def polygons(run: Trajectory, steps: Iterable[int] | None = None) -> Iterator[tuple[float, FloatArray, FloatArray]]:
    """Yield the length of each step, control points of the agents' paths, (n, 6, 3), and path errors."""
    path = run.path
    for k in range(len(path.t) - 1) if steps is None else steps:
        h = float(path.t[k + 1] - path.t[k])
        points, _, allowance = bernstein(h, *(x[k + side] for side in (0, 1) for x in (path.q, path.p, path.u)))
        yield h, points, allowance if path.slack is None else allowance + path.slack[k]


def _legs(h: float, points: FloatArray) -> FloatArray:
    """Return the Bézier control points of velocities from those of the agents' paths."""
    return 5.0 / h * np.diff(points, axis=1)


@dataclass(frozen=True)
class Nets:
    """Bounds on components and links of the net, at samples or throughout intervals."""

    # components, components_least: Number of components at most, and at least: without and with the pairs of which it
    # is open
    components: FloatArray
    components_least: FloatArray
    giant: FloatArray  # giant, giant_most: Agents in the largest component at least, and at most
    giant_most: FloatArray
    links: FloatArray  # Pairs that are linked for certain
    open_links: FloatArray  # Pairs of which it is open, at r but for rounding or for what they may do between samples


def reach(seen: Observed) -> float:
    """Return the distance below which agents are linked: r of the lattice, or the range of the pair law."""
    return float(seen.law.alpha.range if seen.law.lattice is None else seen.law.lattice[1])


def nets_at(seen: Observed) -> Nets:
    """Return the net at each sample of a run of a law with a range."""
    return seen.cached("nets at samples", lambda: _nets_at(seen))


def _nets_at(seen: Observed) -> Nets:
    r, rows, doubt = reach(seen), [], _rounding(seen) + 2.0 * seen.shape_error.max(axis=1)
    for k, q in enumerate(seen.run.q):
        if not np.isfinite(doubt[k]):
            return _unknown_nets(seen, len(seen.t))
        pairs = links(q, r + doubt[k])
        rows.append(_row(seen.run, k, pairs, link_lengths(q, pairs) < r - doubt[k]))
    return _nets(rows)


def nets_between(seen: Observed) -> Nets:
    """Return the net in each interval between samples; pairs that may reach r are left open."""
    return seen.cached("nets between samples", lambda: _nets_between(seen))


def _nets_between(seen: Observed) -> Nets:
    if seen.is_map:
        return Nets(*(getattr(nets_at(seen), field.name)[:-1] for field in fields(Nets)))
    if seen.doubt:
        return _unknown_nets(seen, len(seen.t) - 1)
    run, r, rounding, rows = seen.run, reach(seen), _rounding(seen), []
    h, (speed, force, path_error), first = np.diff(run.t), _motion(seen), np.searchsorted(run.path.t, run.t)
    for k in range(len(run.t) - 1):
        error = 2.0 * float(path_error[k]) + rounding
        pairs = links(run.q[k], r + 4.0 * float(speed[k] * h[k]) + 2.0 * error)
        ends = np.stack([link_lengths(run.q[k], pairs), link_lengths(run.q[k + 1], pairs)])
        low, high = ends.min(axis=0), ends.max(axis=0)
        slack = _slack(low, r, h[k], 2.0 * speed[k], 2.0 * force[k]) + error
        if (unsure := (low - slack < r) & (high + slack >= r)).any():  # those two do not move as fast as the fastest
            own_paths = _relative(run, range(first[k], first[k + 1]), pairs[unsure])
            own_paths[0][:] += 2.0 * seen.between_speed_error[k]
            slack[unsure] = np.minimum(slack[unsure], _slack(low[unsure], r, h[k], *own_paths) + error)
        near = low - slack < r
        rows.append(_row(run, k, pairs[near], (high + slack < r)[near]))
    return _nets(rows)


def _unknown_nets(seen: Observed, count: int) -> Nets:
    """Return nets without known links."""
    n = seen.n
    return _nets([(n, 1, 1, n, 0, n * (n - 1) // 2)] * count)


def _slack(low: FloatArray, r: Any, h: Any, speed: Any, force: Any) -> FloatArray:
    """Return how far a distance may exceed its interval's end values, given relative speed and acceleration."""
    straight_part, curved_part = 0.5 * speed * h, h**2 / 8.0 * (2.0 * speed**2 / r + force)
    return np.where(low - straight_part >= 0.5 * r, np.minimum(straight_part, curved_part), straight_part)


def _relative(run: Trajectory, steps: range, pairs: LinkArray) -> tuple[FloatArray, FloatArray]:
    """Return the largest relative speed and acceleration of given pairs over given steps."""
    speed, force = np.zeros((2, len(pairs)))
    for h, points, _ in polygons(run, steps):
        control_legs = _legs(h, points[pairs[:, 1]] - points[pairs[:, 0]])
        speed = np.maximum(speed, lengths(control_legs).max(axis=1))
        force = np.maximum(force, lengths(4.0 / h * np.diff(control_legs, axis=1)).max(axis=1))
    return speed, force


def _rounding(seen: Observed) -> float:
    """Return the rounding of a distance of two agents, relative to r."""
    return float(16.0 * EPS * (np.abs(seen.run.q).max() + reach(seen)))


def _row(run: Trajectory, k: int, pairs: LinkArray, certain: npt.NDArray[np.bool_]) -> tuple[float, ...]:
    """Return bounds on components, largest component and links, from possible and certain links."""
    count = int(certain.sum())
    if count == len(pairs):
        number = run.n - float(run.metric("connectivity")[k]) * (run.n - 1)
        giant_size = run.n * float(run.metric("giant_share")[k])
        return round(number), round(number), round(giant_size), round(giant_size), count, 0
    fewest, most = (np.bincount(components(run.n, linked)) for linked in (pairs[certain], pairs))
    return fewest.size, most.size, int(fewest.max()), int(most.max()), count, len(pairs) - count


def _nets(rows: list[tuple[float, ...]]) -> Nets:
    return Nets(*np.array(rows, dtype=np.float64).reshape(-1, 6).T)
