"""Velocities and accelerations from recorded positions, with errors, and gaps filled within a stated bound."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray, ensure_positive
from flockana.recorded.sample_interface import Samples
from flockana.recorded.smoothing import smoothed

_Recording = TypeVar("_Recording", bound=Samples)
_FEWEST = 4  # samples of a piece from which velocities are made
_MISSED = 1.75  # times an agent's usual interval, from which on a sample is missing
_DEPENDENT = 2.0  # times the deviation of independent errors: what those of a bound or a grid may add up to
_COARSE = 1.0  # deviations that a grid is wider than whose rounding makes errors dependent
_GRID = 1e-6  # of a grid's step, within which numbers are rounded to it


@dataclass(frozen=True, eq=False)
class Motions:
    """Positions, velocities and accelerations by smoothing splines, shape (T, n, m), and standard deviations (T, n).

    All are NaN where an agent was not seen, and in pieces of fewer than four samples between gaps.
    """

    q: FloatArray
    p: FloatArray
    u: FloatArray
    q_sd: FloatArray  # q_sd, p_sd, u_sd: of each coordinate
    p_sd: FloatArray
    u_sd: FloatArray
    noise: float  # standard deviation of a coordinate, stated or estimated

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """Whether the motion of an agent is known at a sample, shape (T, n)."""
        return ~np.isnan(self.p[:, :, 0])


def motions(rec: Samples) -> Motions:
    """Return the smoothing splines of a recording, with stated noise, else the likeliest."""
    return rec.cached("motions", lambda: _motions(rec))


def _motions(rec: Samples) -> Motions:
    pieces = pieces_of(rec)
    whole = [np.bincount(x[x >= 0], minlength=1) for x in np.where(rec.present, pieces, -1).T]
    short = np.stack([np.append(count < _FEWEST, True)[x] for count, x in zip(whole, pieces.T, strict=True)], axis=1)
    (count, n, m), grid = rec.q.shape, grid_of(rec.q)
    noise = _coordinate_noise(rec)
    is_rounded = grid > 0.0 and (noise is None or grid > _COARSE * float(np.max(noise)))
    noise_factor = _DEPENDENT if rec.bound is not None or is_rounded else 1.0
    if bool((short | ~rec.present).all()):
        none, bare = np.full(rec.q.shape, np.nan), np.full(rec.present.shape, np.nan)
        return Motions(none, none, none, bare, bare, bare, 0.0)
    noise_rows = None if noise is None else np.repeat(np.broadcast_to(noise, (count, n)), m, axis=1)
    series, split = rec.q.reshape(count, n * m), np.repeat(pieces, m, axis=1)
    fit = smoothed(rec.t, series, noise_rows, split, groups=m, floor=grid / np.sqrt(12.0))
    (q, p, u), deviations = ([x[:, :, k].reshape(count, n, m) for k in range(3)] for x in (fit.mean, fit.sd))
    q_sd, p_sd, u_sd = (noise_factor * deviation.max(axis=2) for deviation in deviations)
    for x in (q, p, u, q_sd, p_sd, u_sd):
        x[short | ~rec.present] = np.nan
    return Motions(q, p, u, q_sd, p_sd, u_sd, fit.noise)


def _coordinate_noise(rec: Samples) -> Any:
    """Return the standard deviation of a coordinate from the stated accuracy; uniform within a bound."""
    if rec.bound is None:
        return rec.sd
    return np.divide(rec.bound, np.sqrt(3.0))


def grid_of(q: FloatArray) -> float:
    """Return the rounding grid step of the positions; 0 without a grid.

    Examples
    --------
    >>> grid_of(np.array([0.25, 1.5, 1.75, 4.0, 0.5]))
    0.25
    """
    values = np.unique(q[~np.isnan(q)])
    steps = np.diff(values)
    magnitude = float(np.abs(values).max(initial=0.0))
    steps = steps[steps > 1e-12 * magnitude]
    if len(steps) < 3:
        return 0.0
    step = float(steps.min())
    deviation = np.abs(steps / step - np.rint(steps / step))
    return step if (deviation < np.maximum(_GRID, 1e-12 * magnitude / step)).all() else 0.0


def pieces_of(rec: Samples) -> npt.NDArray[np.intp]:
    """Return the number of the gap-free part of each sample and agent, shape (T, n); -1 outside.

    A gap is an interval in which an agent has missed a sample, by its own usual interval.
    """
    pieces = np.full(rec.present.shape, -1, dtype=np.intp)
    for i in range(rec.n):
        rows = np.flatnonzero(rec.present[:, i])
        steps = np.diff(rec.t[rows])
        is_gap = steps > _MISSED * (float(np.median(steps)) if len(steps) else 1.0)
        number = np.concatenate([[0], np.cumsum(is_gap)])
        last_known = np.full(len(rec.t), -1)
        last_known[rows] = np.arange(len(rows))
        last_known = np.maximum.accumulate(last_known)  # the sample before
        is_inside = (last_known >= 0) & (np.arange(len(rec.t)) <= rows[-1])
        last_rows = last_known[is_inside]
        next_rows = np.minimum(last_rows + (rec.t[is_inside] > rec.t[rows[last_rows]]), len(rows) - 1)
        pieces[is_inside, i] = np.where(number[last_rows] == number[next_rows], number[last_rows], -1)
    return pieces


def with_velocities(rec: _Recording) -> _Recording:
    """Return the recording with smoothed velocities, see `Recording.with_velocities`; these decide no verdict."""
    fit = motions(rec)
    unknown = rec.bound is None and rec.sd is None
    change: dict[str, Any] = {"sd": fit.noise, "estimated": True} if unknown else {}
    p_sd = np.where(fit.known, fit.p_sd, 0.0)
    return replace(rec, p=fit.p, u=fit.u, p_sd=p_sd, p_bound=None, smoothed=True, **change)  # type: ignore[type-var]  # each is a dataclass


class _Ends(NamedTuple):
    """Positions and velocities before and after a gap, (2, m) each, with errors, (2,); inf where unknown."""

    q: FloatArray
    p: FloatArray
    off_q: FloatArray
    off_p: FloatArray


def filled(rec: _Recording, most: float | None, longest: float | None) -> _Recording:
    """Return a recording with its gaps filled, with error bounds from a greatest acceleration."""
    if not rec.gaps or most is None:
        return rec
    most = ensure_positive("most_acceleration", most)
    reach = np.inf if longest is None else ensure_positive("longest", longest)
    fit = motions(rec) if rec.bound is None else None
    name, stated_value = ("bound", rec.bound) if fit is None else ("sd", rec.sd if rec.sd is not None else fit.noise)
    error: FloatArray = np.broadcast_to(np.asarray(stated_value, dtype=np.float64), rec.present.shape).copy()
    is_p_stated = fit is not None or not rec.smoothed  # no bound holds of smoothed velocities
    p_name = f"p_{name}" if is_p_stated else "p_sd"
    p, speed = rec.p, getattr(rec, p_name)
    if p is None:  # those of the smoothing splines, or none that a bound holds of
        p = np.full(rec.q.shape, np.nan) if fit is None else fit.p
        speed = np.inf if fit is None else np.nan_to_num(fit.p_sd, nan=np.inf)
    slip: FloatArray = np.broadcast_to(error / rec.interval if speed is None else speed, rec.present.shape).copy()
    q, p = rec.q.copy(), p.copy()
    for i, gap, duration in _gaps(rec):
        if duration <= reach:
            gap_ends, fractions = [gap.start - 1, gap.stop], (rec.t[gap] - rec.t[gap.start - 1]) / duration
            off_p = slip[gap_ends, i] if is_p_stated else np.full(2, np.inf)
            ends = _Ends(rec.q[gap_ends, i], p[gap_ends, i], error[gap_ends, i], off_p)
            q[gap, i], error[gap, i], p[gap, i], slip[gap, i] = _bridge(fractions, duration, ends, most)
    change: dict[str, Any] = {"q": q, "u": None, name: error}
    if rec.p is not None:
        change |= {"p": p, p_name: slip}
    return replace(rec, estimated=rec.estimated or (rec.bound is None and rec.sd is None), **change)  # type: ignore[type-var]  # each is a dataclass


def _bridge(
    s: FloatArray, duration: float, ends: _Ends, most: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return positions and velocities at fractions s of a gap, with error bounds over all allowed motions.

    The cubic through both ends, or the chord where velocities are not known or say less. A motion whose acceleration is
    ``most`` at most is off by ``most`` times the integral of the absolute value of Peano's kernel; errors of ends add.
    """
    ones, zeros = np.ones(len(s)), np.zeros((2, len(s)))
    rise, rise_slope = s**2 * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / duration
    forms = [
        [(np.stack([1.0 - s, s]), zeros), (np.stack([-ones, ones]) / duration, zeros)],
        [
            (np.stack([1.0 - rise, rise]), duration * np.stack([s * (1.0 - s) ** 2, -(s**2) * (1.0 - s)])),
            (np.stack([-rise_slope, rise_slope]), np.stack([1.0 - 4.0 * s + 3.0 * s**2, 3.0 * s**2 - 2.0 * s])),
        ],
    ]
    is_told = bool(np.isfinite(ends.off_p).all() and np.isfinite(ends.p).all())
    p, velocity_error = (ends.p, ends.off_p) if is_told else (np.zeros(ends.p.shape), np.zeros(2))
    pieces = []
    for order in (0, 1):
        best_values, error = np.zeros((len(s), ends.q.shape[1])), np.full(len(s), np.inf)
        for form in forms[: 1 + is_told]:
            by_q, by_p = form[order]
            bound = most * _kernel(s, duration, by_q[1], by_p[1], order)
            bound = bound + np.abs(by_q).T @ ends.off_q + np.abs(by_p).T @ velocity_error
            best_values = np.where((bound < error)[:, None], by_q.T @ ends.q + by_p.T @ p, best_values)
            error = np.minimum(bound, error)
        pieces += [best_values, error]
    return pieces[0], pieces[1], pieces[2], pieces[3]


def _kernel(s: FloatArray, duration: float, by_q: FloatArray, by_p: FloatArray, order: int) -> FloatArray:
    """Return the integral of |Peano kernel| of an interpolation, or of its slope, at fractions s of a gap."""

    def kernel(x: FloatArray | float) -> tuple[Any, Any]:
        after = -by_q * (1.0 - x) * duration - by_p
        return after + ((s - x) * duration if order == 0 else 1.0), after

    def area(a: FloatArray, b: FloatArray, width: FloatArray) -> FloatArray:  # of |a line| from a to b
        total = np.abs(a) + np.abs(b)
        crossing = np.divide(a**2 + b**2, total, out=np.zeros_like(total), where=total > 0.0)
        result: FloatArray = 0.5 * width * np.where(a * b < 0.0, crossing, total)
        return result

    at_s = kernel(s)
    return duration * (area(kernel(0.0)[0], at_s[0], s) + area(at_s[1], kernel(1.0)[1], 1.0 - s))


def _gaps(rec: Samples) -> Iterator[tuple[int, slice, float]]:
    """Yield gaps as (agent, missing samples, time from the previous to the next sample)."""
    for i in range(rec.n):
        for a, b in pairwise(np.flatnonzero(rec.present[:, i]).tolist()):
            if b > a + 1:
                yield i, slice(a + 1, b), float(rec.t[b] - rec.t[a])
