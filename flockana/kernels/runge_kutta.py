"""One step of an explicit Runge-Kutta pair on (positions, velocities, work), its error estimate and its interpolant.

A tableau (`flockana.solvers.tableau`) is (A, C, E, P): row s of A has the weights of the step itself, so that stage s
is the rate at its end; rows beyond it are stages of the interpolant alone. E has one row, the error estimate, or two,
those of DOP853; P the interpolant, y(θ) = y + h Σ_jk P_jk θᵏ⁺¹ K_j. The rate K_s is kept in row rows[s] of the step's
rates.
"""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from flockana.jit import inlined, kernel, register_jitable, subroutine
from flockana.kernels.agent_sums import column_squares, squared_deviations
from flockana.kernels.verlet_list import COUNT


class Method(NamedTuple):
    """Runge-Kutta method (`flockana.solvers.tableau.Tableau`) with the tolerances of a run."""

    a: Any
    c: Any
    estimates: Any
    interpolant: Any
    rows: Any
    stages: Any
    exponent: Any
    lead: Any
    rtol: Any  # relative tolerance
    floor: Any  # absolute ones: of positions, velocities and work
    longest: Any  # longest step


class Step(NamedTuple):
    """Work arrays of a step: start, length, vectors at both ends, stage rates, and a spare vector."""

    t: Any
    h: Any
    y: Any
    reached: Any
    rates: Any
    trial: Any


class Work(NamedTuple):
    """Callbacks for listing pairs, checking lists and summing stages, for one thread or several."""

    listed: Any  # `flockana.kernels.verlet_list.listed_anew`
    covers: Any
    combine: Any


class System(NamedTuple):
    """Law in the form that integration steps call: functions, parameters, reference frame, work space."""

    force: Any  # `flockana.kernels.law_kernels.LawFunctions`
    energy: Any
    law: Any  # what they read
    seen_from: Any  # start, origin and drift of the frame of the vectors
    moving: Any  # whether the energy is that in the moving frame
    reach: Any  # distance within which all pairs are needed, and the skin of a list
    work: Any  # `Work`: what takes time beside them
    order: Any  # (n,), uint64: every agent's own number
    frame: Any  # room (`flockana.kernels.listed_pairs.Listed`)
    near: Any
    room: Any


STRIP = 1024  # components at once: what is summed over the stages stays in the first-level cache


@register_jitable
def combine_strip(begin, y, h, weights, rates, rows, count, out):
    """Combine stage rates, y + h Σ weights_j K_j, for a strip of consecutive components."""
    end = min(begin + STRIP, y.size)
    total, start = out[begin:end], y[begin:end]
    total[:] = 0.0
    for j in range(count):
        if weights[j] != 0.0:
            rate, weight = rates[rows[j], begin:end], weights[j]
            for k in range(end - begin):
                total[k] += weight * rate[k]
    for k in range(end - begin):
        total[k] = start[k] + h * total[k]


@kernel
def combine(y, h, weights, rates, rows, count, out):
    """Write y + h Σ weights_j K_j over the first `count` Runge-Kutta stages into `out`."""
    for begin in range(0, y.size, STRIP):
        combine_strip(begin, y, h, weights, rates, rows, count, out)


@subroutine
def frame_at(t, view, frame):
    """Write position and velocity of the vectors' reference frame."""
    start, origin, drift = view
    for c in range(origin.size):
        frame[0, c], frame[1, c] = origin[c] + drift[c] * (t - start), drift[c]


@subroutine
def rate_of(t, y, f, system, pairs):
    """Write the rate of the vector y into f; list pairs again unless the list is still complete."""
    n, m, law, frame, (reach, skin) = system.order.size, system.frame.shape[1], system.law, system.frame, system.reach
    size = n * m
    x, v, u = y[:size].reshape(n, m), y[size : 2 * size].reshape(n, m), f[size : 2 * size].reshape(n, m)
    if reach > 0.0 and not system.work.covers(pairs, x, reach):
        system.work.listed(x, reach + skin, pairs)
    frame_at(t, system.seen_from, frame)
    for k in range(size):
        f[k], f[size + k] = y[size + k], 0.0
    f[2 * size] = system.force(
        t, x, v, u, frame, law.numbers, law.panels, law.starts, pairs.first, pairs.second, pairs.counts[COUNT],
        pairs.cuts[1 : pairs.cuts[0] + 2], system.order, system.near, system.room,
    )  # fmt: skip


@subroutine
def energy_of(t, y, system, pairs):
    """Return the energy H of a vector with listed pairs: potential plus kinetic energy in the law's frame."""
    n, m, law, frame = system.order.size, system.frame.shape[1], system.law, system.frame
    x, v, total = y[: n * m].reshape(n, m), y[n * m : 2 * n * m].reshape(n, m), 0.0
    frame_at(t, system.seen_from, frame)
    if system.moving:
        total = 0.5 * squared_deviations(v)
    else:
        for c in range(m):
            total += 0.5 * column_squares(v, c, -frame[1, c])
    return total + system.energy(
        t, x, v, frame, law.numbers, law.panels, law.starts, pairs.first, pairs.second, pairs.counts[COUNT],
        pairs.cuts[1 : pairs.cuts[0] + 2], system.order, system.near, system.room,
    )  # fmt: skip


@subroutine
def stages_of(step, method, begin, end, system, pairs):
    """Compute Runge-Kutta stages `begin` to `end` of a step; `reached` receives the step's result."""
    rows, rates = method.rows, step.rates
    for s in range(begin, end):
        target_row = step.reached if s == method.stages else step.trial
        system.work.combine(step.y, step.h, method.a[s], rates, rows, s, target_row)
        if method.lead != 0.0:  # of one stage, whose rate is in row 0
            for k in range(target_row.size // 2):
                target_row[k] += method.lead * step.h * step.h * rates[0, target_row.size // 2 + k]
        rate_of(step.t + method.c[s] * step.h, target_row, rates[rows[s]], system, pairs)


@inlined
def interpolated(theta, step, method, combining):
    """Write the interpolated state vector at the fraction θ of a step into the step's spare array."""
    interpolant = method.interpolant
    count, powers = interpolant.shape
    weights = np.empty(count)
    for j in range(count):
        weights[j] = 0.0
        for k in range(powers - 1, -1, -1):
            weights[j] = (weights[j] + interpolant[j, k]) * theta
    combining(step.y, step.h, weights, step.rates, method.rows, count, step.trial)


@inlined
def _allowed(k, size, floor):
    """Return the absolute tolerance of component k: a position, a velocity, or the work."""
    return floor[0] if k < size else (floor[1] if k < 2 * size else floor[2])


@inlined
def error_of(step, method):
    """Return the estimated error of a step relative to its tolerance, weighted as in scipy's solvers."""
    h, y, stop, strip, squared_value, other_square = abs(step.h), step.y, step.reached, step.trial, 0.0, 0.0
    for estimate in range(len(method.estimates)):
        weights, squared_value, other_square = method.estimates[estimate], 0.0, squared_value
        for begin in range(0, y.size, STRIP):
            end = min(begin + STRIP, y.size)
            for k in range(end - begin):
                strip[k] = 0.0
            for j in range(weights.size):
                if weights[j] != 0.0:
                    rate, weight = step.rates[method.rows[j], begin:end], weights[j]
                    for k in range(end - begin):
                        strip[k] += weight * rate[k]
            for k in range(begin, end):
                scale = _allowed(k, y.size // 2, method.floor) + max(abs(y[k]), abs(stop[k])) * method.rtol
                squared_value += (strip[k - begin] / scale) ** 2
    if len(method.estimates) == 1:
        return h * sqrt(squared_value / y.size)
    fifth, third_value = other_square, squared_value  # the orders of DOP853's two estimates
    return h * fifth / sqrt((fifth + 0.01 * third_value) * y.size) if fifth != 0.0 or third_value != 0.0 else 0.0


@subroutine
def _weighed(a, b, y, method):
    """Return the root mean square of a − b relative to the tolerance."""
    total = 0.0
    for k in range(y.size):
        total += ((a[k] - b[k]) / (_allowed(k, y.size // 2, method.floor) + abs(y[k]) * method.rtol)) ** 2
    return sqrt(total / y.size)


@inlined
def first_step(span, step, method, system, pairs):
    """Return the length of the first step by scipy's rule; the second rate is overwritten."""
    y, rates, trial = step.y, step.rates, step.trial
    zeros = np.empty(y.size)
    zeros[:] = 0.0
    d0, d1 = _weighed(y, zeros, y, method), _weighed(rates[0], zeros, y, method)
    trial_step = min(1e-6 if d0 < 1e-5 or d1 < 1e-5 else 0.01 * d0 / d1, span)
    for k in range(y.size):
        trial[k] = y[k] + trial_step * rates[0, k]
    rate_of(step.t + trial_step, trial, rates[1], system, pairs)
    d2 = _weighed(rates[1], rates[0], y, method) / trial_step
    h = max(1e-6, trial_step * 1e-3) if d1 <= 1e-15 and d2 <= 1e-15 else (0.01 / max(d1, d2)) ** -method.exponent
    return min(min(100.0 * trial_step, h), span)
