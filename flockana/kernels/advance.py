"""Many steps of a run in one compiled call: error control, encounters, the energy's balance, samples between steps.

What is decided is decided as in `flockana.dynamics.stepping`, which steps scipy's solvers: the same constants, the same
checks in the same order. Agents are sorted by cell for the time of a call; what goes in and out is in their own order.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from flockana.kernels.compiling import njit
from flockana.kernels.encounters import share_of_all, share_of_pairs
from flockana.kernels.listed import signatures
from flockana.kernels.paths import bernstein, centred
from flockana.kernels.runge_kutta import combine, energy_of, error_of, first_step, frame_at, rate_of
from flockana.kernels.verlet import empty_list, list_pairs, spatial_order

RUNNING, TOO_SMALL, NOT_FINITE = range(3)
_SAFETY, _LEAST, _MOST = 0.9, 0.2, 10.0  # scipy's: factors of a step
_ROUNDINGS = 64.0  # of the time: a step of so few is not made again
_HALVINGS, _FALLS, _HELPS, _PATIENCE = 4, 0.04, 0.25, 4  # see `flockana.dynamics.stepping`
_GROWTH = 8.0  # see `flockana.dynamics.rk4`
_FEW = 48  # agents up to which all pairs are looked at rather than listed


@njit(cache=True, error_model="numpy", nogil=True)
def _spacing(t):
    return np.nextafter(abs(t), np.inf) - abs(t)


@njit(cache=True, error_model="numpy", nogil=True)
def met(h, shape, y0, f0, y1, f1, radii, far, reach, pairs, scratch):
    """How much of a step may be taken so that no encounter of two agents is leapt over, and scratch lists."""
    n, m = shape
    size = n * m
    q0, p0, u0 = y0[:size].reshape(n, m), y0[size : 2 * size].reshape(n, m), f0[size : 2 * size].reshape(n, m)
    q1, p1, u1 = y1[:size].reshape(n, m), y1[size : 2 * size].reshape(n, m), f1[size : 2 * size].reshape(n, m)
    points, _, allowance = bernstein(h, q0, p0, u0, q1, p1, u1)
    ways = centred(points, allowance)
    if n <= _FEW:
        return share_of_all(points, ways, allowance, radii, far), scratch
    search = (radii.max() + 2.0 * (ways.max() + allowance.max())) * (1.0 + 1e-9)
    first, second, count, places, _ = pairs
    if places.size and search <= reach[0]:
        return share_of_pairs(points, ways, allowance, radii, far, first[:count], second[:count], 1.0), scratch
    first, second, count = list_pairs(q0, search, scratch[0], scratch[1])
    share = share_of_pairs(points, ways, allowance, radii, far, first[:count], second[:count], 1.0)
    return share, (first, second)


@njit(cache=True, error_model="numpy", nogil=True)
def balanced(before, after, first, last, done, share, floor, ledger, tried, count):
    """(how much of a step may be taken, halvings so far) by the energy's balance; the ledger is kept."""
    residual = abs(last - first - done)
    largest = max(ledger[2], abs(first), abs(last))
    off = residual > max(share * largest, floor)
    worst = 0.0
    for k in range(count + 1 - _HALVINGS):
        worst = max(worst, tried[k])
    if off and count < tried.size and (count < _HALVINGS or residual <= _FALLS * worst):
        ledger[0], ledger[1], tried[count] = before, first, residual
        return 0.5, count + 1
    if count:
        ledger[3] = 0.0 if residual <= tried[0] * _HELPS**count else ledger[3] + 1.0
    ledger[0], ledger[1], ledger[2] = after, last, largest
    return 1.0, 0


@njit(cache=True, error_model="numpy", nogil=True)
def _sorted(vector, order, shape, back, out):
    """The vector in the sorted order, or from there back."""
    n, m = shape
    for i in range(n):
        own = np.int64(order[i])
        a, b = (i, own) if back else (own, i)
        for c in range(m):
            out[b * m + c], out[n * m + b * m + c] = vector[a * m + c], vector[n * m + a * m + c]
    out[2 * n * m] = vector[2 * n * m]


@njit(cache=True, error_model="numpy", nogil=True)
def _record(t, y, f, shape, view, order, q, p, u):
    """Positions, velocities and accelerations as they are, in the agents' own order."""
    n, m = shape
    frame = frame_at(t, *view)
    for i in range(n):
        own = np.int64(order[i])
        for c in range(m):
            q[own, c] = y[i * m + c] + frame[0, c]
            p[own, c] = y[n * m + i * m + c] + frame[1, c]
            u[own, c] = f[n * m + i * m + c]


def _advance(
    act0, act1, act2, energy0, energy1, energy2, numbers, panels, shape, view, moving,
    tableau_a, tableau_c, estimates, interpolant, stages, exponent,
    reach, radii, far, rtol, floor, balance, ledger, t, y, f, h, stops, due, most,
):  # fmt: skip
    """Make up to `most` steps that stand, to the last of `stops`.

    Returns (status, t, y, f, h, steps made, evaluations, steps made again, times, q, p, u, work of each step, and q, p,
    u and work at the times `due` that were passed, NaN where a step ended).
    """
    n, m = shape
    size, fixed = n * m, exponent == 0.0
    acts, energies = (act0, act1, act2), (energy0, energy1, energy2)
    side = reach[0] if reach[0] > 0.0 else np.inf
    start = np.empty((n, m))
    for i in range(n):
        for c in range(m):
            start[i, c] = y[i * m + c]
    order = spatial_order(start, side + reach[1]) if side < np.inf else np.arange(n).astype(np.uint64)
    own_radii = np.empty(radii.shape)
    for i in range(n):
        own_radii[i] = radii[np.int64(order[i])]
    rates = np.zeros((max(tableau_a.shape[0] if due.size else 0, stages + 1), y.size))
    now, reached, trial = np.empty(y.size), np.empty(y.size), np.empty(y.size)
    _sorted(y, order, shape, False, now)
    _sorted(f, order, shape, False, rates[0])
    pairs, scratch = empty_list(n), (np.empty(8 * n, np.uint32), np.empty(8 * n, np.uint32))
    times, work = np.empty(most), np.empty(most)
    qs, ps, us = np.empty((most, n, m)), np.empty((most, n, m)), np.empty((most, n, m))
    between, done = np.empty((due.size, 3, n, m)), np.empty(due.size)
    made, evaluations, redone, sampled, status, stop = 0, 0, 0, 0, RUNNING, 0
    tried, halved, taken = np.empty(64), 0, np.inf
    if not fixed and h == 0.0:
        ahead = first_step(0.0, now, rates[0], rates[0], stops[-1] - t, exponent, size, rtol, floor)
        for k in range(y.size):
            trial[k] = now[k] + ahead * rates[0, k]
        pairs = rate_of(t + ahead, trial, rates[1], shape, acts, numbers, panels, view, reach, pairs, order)
        evaluations += 1
        h = first_step(ahead, now, rates[0], rates[1], stops[-1] - t, exponent, size, rtol, floor)
    while made < most and stop < stops.size and status == RUNNING:
        shortest, rejected, limit = 10.0 * _spacing(t), False, np.inf
        if fixed:
            h = min(stops[stop] - t, _GROWTH * taken)
        else:
            h = max(h, shortest)
        later = h
        while True:
            h = min(h, limit)
            if h < shortest and not fixed:
                status = TOO_SMALL
                break
            at = t + h
            if at > stops[stop] or (fixed and h == stops[stop] - t):
                at = stops[stop]
            h = at - t
            for s in range(1, stages + 1):
                into = reached if s == stages else trial
                combine(now, h, tableau_a[s], rates, s, into)
                place = at if s == stages else t + tableau_c[s] * h
                pairs = rate_of(place, into, rates[s], shape, acts, numbers, panels, view, reach, pairs, order)
            evaluations += stages
            if not fixed:
                error = error_of(now, reached, h, estimates, rates, size, rtol, floor)
                if not error < 1.0:
                    factor = _SAFETY * error**exponent
                    h, rejected = h * (factor if factor > _LEAST else _LEAST), True
                    continue
                factor = _MOST if error == 0.0 else min(_MOST, _SAFETY * error**exponent)
                later = h * (min(1.0, factor) if rejected else factor)
            finite = np.isfinite(reached).all() and np.isfinite(rates[stages]).all()
            if not finite:
                status = NOT_FINITE
                break
            share = 1.0
            if radii.size and n > 1:
                share, scratch = met(
                    h, shape, now, rates[0], reached, rates[stages], own_radii, far, reach, pairs, scratch
                )
            if share == 1.0 and balance[0] > 0.0 and ledger[3] < _PATIENCE:
                last = energy_of(at, reached, shape, moving, energies, numbers, panels, view, pairs, order)
                if ledger[0] != t:
                    ledger[0] = t
                    ledger[1] = energy_of(t, now, shape, moving, energies, numbers, panels, view, pairs, order)
                change = reached[2 * size] - now[2 * size]
                share, halved = balanced(t, at, ledger[1], last, change, balance[0], balance[1], ledger, tried, halved)
            if fixed:
                if share == 1.0 or t + share * h == t:
                    break
                h *= max(share, 1.0 / _GROWTH)
            else:
                if share == 1.0 or share * h <= _ROUNDINGS * _spacing(max(abs(t), abs(at))):
                    break
                h, limit, rejected = share * h, share * h, False
            redone += 1
        if status != RUNNING:
            break
        if sampled < due.size and due[sampled] < at:
            count = tableau_a.shape[0]
            for s in range(stages + 1, count):
                combine(now, h, tableau_a[s], rates, s, trial)
                pairs = rate_of(
                    t + tableau_c[s] * h, trial, rates[s], shape, acts, numbers, panels, view, reach, pairs, order
                )
            evaluations += count - stages - 1
            weights, here = np.empty(count), np.empty(y.size)
            while sampled < due.size and due[sampled] < at:
                theta = (due[sampled] - t) / h
                for j in range(count):
                    weights[j] = 0.0
                    for k in range(interpolant.shape[1] - 1, -1, -1):
                        weights[j] = (weights[j] + interpolant[j, k]) * theta
                combine(now, h, weights, rates, count, trial)
                pairs = rate_of(due[sampled], trial, here, shape, acts, numbers, panels, view, reach, pairs, order)
                evaluations += 1
                out = between[sampled]
                _record(due[sampled], trial, here, shape, view, order, out[0], out[1], out[2])
                done[sampled] = trial[2 * size]
                sampled += 1
        while sampled < due.size and due[sampled] == at:
            done[sampled], sampled = np.nan, sampled + 1  # the step itself is the sample
        t, taken = at, h
        if at == stops[stop]:
            stop, taken = stop + 1, np.inf
        h = later
        now, reached = reached, now
        rates[0] = rates[stages]
        times[made], work[made] = t, now[2 * size]
        _record(t, now, rates[0], shape, view, order, qs[made], ps[made], us[made])
        made += 1
    state, slope = np.empty(y.size), np.empty(y.size)
    _sorted(now, order, shape, True, state)
    _sorted(rates[0], order, shape, True, slope)
    steps = (times[:made], qs[:made], ps[:made], us[:made], work[:made])
    return status, t, state, slope, h, evaluations, redone, stop, sampled, steps, between[:sampled], done[:sampled]


@cache
def advance() -> Callable[..., Any]:
    """`_advance`, compiled when first asked for: what it is handed functions for, no two laws compile twice."""
    from numba import boolean, float64, int64
    from numba.core import types

    act, energy = (types.FunctionType(signature) for signature in signatures())
    matrix, vector = float64[:, ::1], float64[::1]
    numbers, panels = types.UniTuple(vector, 3), types.UniTuple(matrix, 3)
    view, two, three = types.Tuple((float64, vector, vector)), types.UniTuple(float64, 2), types.UniTuple(float64, 3)
    terms = (act, act, act, energy, energy, energy, numbers, panels)
    made = njit(cache=True, error_model="numpy", nogil=True)(_advance)
    made.compile(
        (*terms, types.UniTuple(int64, 2), view, boolean)
        + (matrix, vector, matrix, matrix, int64, float64)
        + (two, matrix, float64, float64, three, two, vector, float64, vector, vector, float64, vector, vector, int64)
    )
    made.disable_compile()
    return made.dispatcher  # type: ignore[no-any-return]
