"""One step of an explicit Runge-Kutta pair on (positions, velocities, work), its error estimate and its interpolant.

A tableau is (A, C, E, P): row s of A has the weights of the step itself, so that stage s is the rate at its end; rows
beyond it are stages of the interpolant alone. E has one row, the error estimate, or two, those of DOP853; P the
interpolant, y(θ) = y + h Σ_jk P_jk θᵏ⁺¹ K_j. The rate K_s is kept in row rows[s] of `rates`.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from flockana.jit import njit
from flockana.kernels.sums import column_squares, squared_deviations
from flockana.kernels.verlet import listed_anew, outdated


class System(NamedTuple):
    """A law as steps take it: its functions and numbers, how the state is seen, and room.

    Attributes
    ----------
    force, energy, guard : callable
        `flockana.kernels.laws.LawFunctions`.
    law : LawNumbers
        What they read.
    seen_from : (float, ndarray, ndarray)
        Start, origin and drift of the frame that vectors are seen from.
    moving : bool
        Whether the energy is that in the moving frame.
    reach : (float, float)
        Within which all pairs are needed, and the skin of a list.
    order : ndarray of uint64, shape (n,)
        Every agent's own number.
    frame, near, room : ndarray
        Room (`flockana.kernels.listed.Listed`).
    """

    force: Any
    energy: Any
    guard: Any
    law: Any
    seen_from: Any
    moving: Any
    reach: Any
    order: Any
    frame: Any
    near: Any
    room: Any


_STRIP = 1024  # components at once: what is summed over the stages stays in the first-level cache


@njit(cache=True, error_model="numpy", nogil=True)
def combine(y, h, weights, rates, rows, count, out):
    """y + h Σ weights_j K_j over the first `count` stages."""
    for begin in range(0, y.size, _STRIP):
        end = min(begin + _STRIP, y.size)
        total = out[begin:end]
        total[:] = 0.0
        for j in range(count):
            if weights[j] != 0.0:
                rate, weight = rates[rows[j], begin:end], weights[j]
                for k in range(end - begin):
                    total[k] += weight * rate[k]
        start = y[begin:end]
        for k in range(end - begin):
            total[k] = start[k] + h * total[k]


@njit(cache=True, error_model="numpy", nogil=True)
def frame_at(t, view, frame):
    """Write place and velocity of the frame that the vectors are seen from."""
    start, origin, drift = view
    for c in range(origin.size):
        frame[0, c], frame[1, c] = origin[c] + drift[c] * (t - start), drift[c]


@njit(cache=True, error_model="numpy", nogil=True)
def rate_of(t, y, f, system, pairs):
    """Write the rate of the vector y into f; returns the pairs, listed anew if need be."""
    pairs = _kept_up(y, system, pairs)
    _act(t, y, f, system, pairs)
    return pairs


@njit(cache=True, error_model="numpy", nogil=True)
def _kept_up(y, system, pairs):
    """The list itself while it holds every pair within reach, or else a new one."""
    (reach, skin), m = system.reach, system.frame.shape[1]
    n = system.order.size
    q = y[: n * m].reshape(n, m)
    return listed_anew(q, reach + skin, pairs) if reach > 0.0 and outdated(q, reach, skin, pairs) else pairs


@njit(cache=True, error_model="numpy", nogil=True)
def _act(t, y, f, system, pairs):
    """The rate of y into f, its pairs being listed."""
    (first, second, count, _), n, m = pairs, system.order.size, system.frame.shape[1]
    size, law, frame = n * m, system.law, system.frame
    x, v, u = y[:size].reshape(n, m), y[size : 2 * size].reshape(n, m), f[size : 2 * size].reshape(n, m)
    frame_at(t, system.seen_from, frame)
    for k in range(size):
        f[k], f[size + k] = y[size + k], 0.0
    f[2 * size] = system.force(
        t, x, v, u, frame, law.numbers, law.panels, law.starts, first, second, count, system.order, system.near,
        system.room,
    )  # fmt: skip


@njit(cache=True, error_model="numpy", nogil=True)
def energy_of(t, y, system, pairs):
    """H of a vector whose pairs are listed: potential energies, and the kinetic one in the law's frame."""
    (first, second, count, _), n, m = pairs, system.order.size, system.frame.shape[1]
    x, v, law, frame, total = (
        y[: n * m].reshape(n, m),
        y[n * m : 2 * n * m].reshape(n, m),
        system.law,
        system.frame,
        0.0,
    )
    frame_at(t, system.seen_from, frame)
    if system.moving:
        total = 0.5 * squared_deviations(v)
    else:
        for c in range(m):
            total += 0.5 * column_squares(v, c, -frame[1, c])
    return total + system.energy(
        t, x, v, frame, law.numbers, law.panels, law.starts, first, second, count, system.order, system.near,
        system.room,
    )  # fmt: skip


@njit(cache=True, error_model="numpy", nogil=True)
def _stages(t, h, y, rates, reached, trial, method, begin, end, system, pairs):
    """Stages up to `end`, or to one for which the list is outdated; returns which, combined but not evaluated."""
    a, c, rows, stages = method
    (reach, skin), n, m = system.reach, system.order.size, system.frame.shape[1]
    for s in range(begin, end):
        into = reached if s == stages else trial
        combine(y, h, a[s], rates, rows, s, into)
        if reach > 0.0 and outdated(into[: n * m].reshape(n, m), reach, skin, pairs):
            return s
        _act(t + c[s] * h, into, rates[rows[s]], system, pairs)
    return end


@njit(cache=True, error_model="numpy", nogil=True)
def stages_of(t, h, y, rates, reached, trial, method, begin, end, system, pairs):
    """Stages `begin` to `end` of a step; `reached` is its end once the last stage of the step itself is through."""
    _, c, rows, stages = method
    s = _stages(t, h, y, rates, reached, trial, method, begin, end, system, pairs)
    while s < end:
        pairs = rate_of(t + c[s] * h, reached if s == stages else trial, rates[rows[s]], system, pairs)
        s = _stages(t, h, y, rates, reached, trial, method, s + 1, end, system, pairs)
    return pairs


@njit(cache=True, error_model="numpy", nogil=True)
def interpolated(theta, h, y, rates, rows, interpolant, trial):
    """The vector at a share θ of the step."""
    count, powers = interpolant.shape
    weights = np.zeros(count)
    for j in range(count):
        for k in range(powers - 1, -1, -1):
            weights[j] = (weights[j] + interpolant[j, k]) * theta
    combine(y, h, weights, rates, rows, count, trial)


@njit(cache=True, error_model="numpy", nogil=True)
def allowed(k, size, floor):
    """The absolute tolerance of component k: a position, a velocity, or the work."""
    return floor[0] if k < size else (floor[1] if k < 2 * size else floor[2])


@njit(cache=True, error_model="numpy", nogil=True)
def _estimate(weights, y, reached, rates, rows, size, rtol, floor, strip):
    """The sum of squares of one estimate of a step's error over what is allowed; `strip` is room."""
    total = 0.0
    for begin in range(0, y.size, _STRIP):
        end = min(begin + _STRIP, y.size)
        for k in range(end - begin):
            strip[k] = 0.0
        for j in range(weights.size):
            if weights[j] != 0.0:
                rate, weight = rates[rows[j], begin:end], weights[j]
                for k in range(end - begin):
                    strip[k] += weight * rate[k]
        for k in range(begin, end):
            scale = allowed(k, size, floor) + max(abs(y[k]), abs(reached[k])) * rtol
            total += (strip[k - begin] / scale) ** 2
    return total


@njit(cache=True, error_model="numpy", nogil=True)
def error_of(y, reached, h, estimates, rates, rows, size, rtol, floor, strip):
    """The estimated error of a step over what is allowed, as scipy's solvers weigh it."""
    square = _estimate(estimates[0], y, reached, rates, rows, size, rtol, floor, strip)
    if estimates.shape[0] == 1:
        return abs(h) * sqrt(square / y.size)
    other = _estimate(estimates[1], y, reached, rates, rows, size, rtol, floor, strip)
    if square == 0.0 and other == 0.0:
        return 0.0
    return abs(h) * square / sqrt((square + 0.01 * other) * y.size)


@njit(cache=True, error_model="numpy", nogil=True)
def _weighed(a, b, y, size, rtol, floor):
    """The root mean square of a − b over what is allowed."""
    total = 0.0
    for k in range(y.size):
        total += ((a[k] - b[k]) / (allowed(k, size, floor) + abs(y[k]) * rtol)) ** 2
    return sqrt(total / y.size)


@njit(cache=True, error_model="numpy", nogil=True)
def first_step(t, span, y, rates, exponent, rtol, floor, trial, system, pairs):
    """(first step, pairs), as scipy's solvers choose it; the second rate is overwritten."""
    size, rest = y.size // 2, np.zeros(y.size)
    d0, d1 = _weighed(y, rest, y, size, rtol, floor), _weighed(rates[0], rest, y, size, rtol, floor)
    ahead = min(1e-6 if d0 < 1e-5 or d1 < 1e-5 else 0.01 * d0 / d1, span)
    for k in range(y.size):
        trial[k] = y[k] + ahead * rates[0, k]
    pairs = rate_of(t + ahead, trial, rates[1], system, pairs)
    d2 = _weighed(rates[1], rates[0], y, size, rtol, floor) / ahead
    h = max(1e-6, ahead * 1e-3) if d1 <= 1e-15 and d2 <= 1e-15 else (0.01 / max(d1, d2)) ** -exponent
    return min(100.0 * ahead, h, span), pairs
