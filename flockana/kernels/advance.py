"""Many steps of a run in one compiled call: error control, encounters, the energy's balance, samples between steps.

What is decided is decided as in `flockana.dynamics.stepping`, which steps scipy's solvers: the same constants, the same
checks in the same order. Agents are sorted by cell for the time of a call; what goes in and out is in their own order.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import njit
from flockana.kernels.encounters import band, common_way, farthest_ways, share_of_listed, steepest
from flockana.kernels.paths import bernstein
from flockana.kernels.poles import crossing_listed
from flockana.kernels.runge_kutta import (
    System,
    energy_of,
    error_of,
    first_step,
    frame_at,
    interpolated,
    rate_of,
    stages_of,
)
from flockana.kernels.sums import finite, put
from flockana.kernels.verlet import empty_list, holds, list_pairs, spatial_order


class Method(NamedTuple):
    """`flockana.kernels.tableaus.Tableau`, and the tolerances of a run.

    Attributes
    ----------
    a, c, estimates, interpolant, rows, stages, exponent
        The tableau.
    rtol, floor, longest, balance : float, (float, float, float), float, (float, float)
        Relative tolerance, absolute ones, longest step, and (share of the energy, energy) that a step's balance may be
        off by.
    """

    a: Any
    c: Any
    estimates: Any
    interpolant: Any
    rows: Any
    stages: Any
    exponent: Any
    rtol: Any
    floor: Any
    longest: Any
    balance: Any


class Around(NamedTuple):
    """What no step may leap over (`flockana.dynamics.encounters.Encounters`).

    Attributes
    ----------
    radii, far : ndarray, float
        Distances at which each agent begins or ceases to feel another, and how far two may go within them.
    bodies : bool
        Whether there are obstacles.
    shell : (float, float)
        Distance at which their force begins, and how far an agent may go within it.
    poles : ndarray
        Distances between agents that no step crosses.
    """

    radii: Any
    far: Any
    bodies: Any
    shell: Any
    poles: Any


class Kept(NamedTuple):
    """What is kept from call to call: time, state, rate, next step, and the ledger of the energy's balance."""

    t: Any
    y: Any
    f: Any
    h: Any
    ledger: Any


RUNNING, TOO_SMALL, NOT_FINITE, CROWDED, SINGULAR = range(5)
_SAFETY, _LEAST, _MOST = 0.9, 0.2, 10.0  # scipy's: factors of a step
ROUNDINGS = 64.0  # of the time: a step of so few is not made again
HALVINGS, FALLS = 4, 0.04  # a residual that so many halvings leave above so much is not the integrator's to mend
HELPS = 0.25  # of the residual, a halving: across a kink of the force it leaves an eighth, of a wrong rate one half
PATIENCE = 4  # steps in a row that halving did not mend, after which none is halved any more
GROWTH = 8.0  # times its last length may a step of RK4 grow, and by so much it is shortened at once


@njit(cache=True, error_model="numpy", nogil=True)
def _spacing(t):
    return np.nextafter(abs(t), np.inf) - abs(t)


@njit(cache=True, error_model="numpy", nogil=True)
def _at_rest(t, h, points, view, frame):
    """The same paths, seen from where the obstacles are at rest."""
    seen, m = points.copy(), view[1].size
    for k in range(6):
        frame_at(t + 0.2 * k * h, view, frame)
        for i in range(len(points)):
            for c in range(m):
                seen[i, k, c] += frame[0, c]
    return seen


@njit(cache=True, error_model="numpy", nogil=True)
def _met(t, h, y0, f0, y1, f1, encounters, system, pairs, scratch):
    """How much of a step may be taken so that no encounter is leapt over, and room for a list.

    NaN where there are too many pairs to look at; negative where a pair crosses a pole.
    """
    (radii, far, bodies, shell, poles), n, m = encounters, system.order.size, system.frame.shape[1]
    size, share, law = n * m, 1.0, system.law
    q0, p0, u0 = y0[:size].reshape(n, m), y0[size : 2 * size].reshape(n, m), f0[size : 2 * size].reshape(n, m)
    q1, p1, u1 = y1[:size].reshape(n, m), y1[size : 2 * size].reshape(n, m), f1[size : 2 * size].reshape(n, m)
    if bodies:
        points, _, allowance = bernstein(h, q0, p0, u0, q1, p1, u1)
        seen = _at_rest(t, h, points, system.seen_from, system.frame)
        share = system.guard(seen, allowance, law.numbers, law.starts, shell[0], shell[1], share)
    if not radii.size or n == 1:
        return share, scratch
    common = common_way(h, q0, p0, u0, q1, p1, u1)
    between = band(common, farthest_ways(h, q0, p0, u0, q1, p1, u1, common), radii, far)
    first, second, count, places = pairs
    reach, skin = system.reach
    if not (places.size and holds(q0, between[1], reach + skin, places)):  # it may lack a pair so near at the beginning
        first, second, count = list_pairs(q0, between[1], scratch[0], scratch[1])
        scratch = (first, second)
        if count < 0:
            return np.nan, scratch
    first, second = first[:count], second[:count]
    ends, ways = (q0, p0, u0, q1, p1, u1), farthest_ways(h, q0, p0, u0, q1, p1, u1, common)
    if poles.size and crossing_listed(h, ends, (steepest(common[1]), ways[0] + ways[1]), poles, first, second):
        return -0.5, scratch
    return share_of_listed(h, q0, p0, u0, q1, p1, u1, common[0], between, radii, far, first, second, share), scratch


@njit(cache=True, error_model="numpy", nogil=True)
def _balanced(t, at, y, reached, balance, ledger, tried, halved, system, pairs):
    """(how much of a step may be taken, halvings so far) by the energy's balance; the ledger is kept."""
    if ledger[0] != t:
        ledger[0], ledger[1] = t, energy_of(t, y, system, pairs)
    first, last = ledger[1], energy_of(at, reached, system, pairs)
    if np.isfinite(first) and not np.isfinite(last):  # the step ends where the potential is infinite
        return -0.5, halved
    residual, largest = abs(last - first - (reached[-1] - y[-1])), max(ledger[2], abs(first), abs(last))
    worst = 0.0
    for k in range(halved + 1 - HALVINGS):
        worst = max(worst, tried[k])
    off = residual > max(balance[0] * largest, balance[1])
    if off and halved < tried.size and (halved < HALVINGS or residual <= FALLS * worst):
        tried[halved] = residual
        return 0.5, halved + 1
    if halved:
        ledger[3] = 0.0 if residual <= tried[0] * HELPS**halved else ledger[3] + 1.0
    ledger[0], ledger[1], ledger[2] = at, last, largest
    return 1.0, 0


@njit(cache=True, error_model="numpy", nogil=True)
def _moved(vector, order, shape, back, out):
    """The vector in the order given, or from there back."""
    n, m = shape
    for i in range(n):
        own = np.int64(order[i])
        a, b = (i, own) if back else (own, i)
        for c in range(m):
            out[b * m + c], out[n * m + b * m + c] = vector[a * m + c], vector[n * m + a * m + c]
    out[2 * n * m] = vector[2 * n * m]


@njit(cache=True, error_model="numpy", nogil=True)
def _record(t, y, f, system, out):
    """Positions, velocities and accelerations as they are, in the agents' own order; returns the work."""
    order, frame = system.order, system.frame
    n, m = order.size, frame.shape[1]
    frame_at(t, system.seen_from, frame)
    for i in range(n):
        own = np.int64(order[i])
        for c in range(m):
            out[0, own, c] = y[i * m + c] + frame[0, c]
            out[1, own, c] = y[n * m + i * m + c] + frame[1, c]
            out[2, own, c] = f[n * m + i * m + c]
    return y[2 * n * m]


@njit(cache=True, error_model="numpy", nogil=True)
def _sampled(t, h, at, y, rates, trial, due, begin, method, interpolant, between, work, system, pairs):
    """Samples at the times due before the end of a step: (samples so far, pairs)."""
    rows, stages, slope = method[2], method[3], np.empty(y.size)
    pairs = stages_of(t, h, y, rates, trial, trial, method, stages + 1, len(rows), system, pairs)
    k = begin
    while k < due.size and due[k] < at:
        interpolated((due[k] - t) / h, h, y, rates, rows, interpolant, trial)
        pairs = rate_of(due[k], trial, slope, system, pairs)
        work[k] = _record(due[k], trial, slope, system, between[k])
        k += 1
    return k, pairs


@njit(cache=True, error_model="numpy", nogil=True)
def _with_room(kept, due, at):
    """Room for the samples due before a time, and those kept so far."""
    needed = len(kept)
    while needed < due.size and due[needed] < at:
        needed += 1
    if needed <= len(kept):
        return kept
    more = np.empty((max(needed, 2 * len(kept)), *kept.shape[1:]))
    put(kept, more)
    return more


@njit(cache=True, error_model="numpy", nogil=True)
def _controlled(h, error, exponent, rejected):
    """(next step, whether this one stands), as scipy's solvers choose."""
    factor = _SAFETY * error**exponent
    if error < 1.0:
        factor = _MOST if error == 0.0 else min(_MOST, factor)
        return h * (min(1.0, factor) if rejected else factor), True
    return h * (factor if factor > _LEAST else _LEAST), False  # of an error that is no number too


@njit(cache=True, error_model="numpy", nogil=True)
def advance(system, around, method, kept, stops, due, most):
    """Make up to `most` steps that stand, to the last of `stops`.

    The system is one whose agents are in their own order. Returns (status, t, y, f, h, evaluations, steps made again,
    stops and due times passed, times, states and work of the steps, states and work at the due times, NaN where a step
    ended).
    """
    (n, m), (t, y, f, h, ledger) = (system.order.size, system.frame.shape[1]), kept
    rtol, floor, balance, exponent = method.rtol, method.floor, method.balance, method.exponent
    stages, rows, estimates, interpolant = method.stages, method.rows, method.estimates, method.interpolant
    shape, start, reach = (n, m), y[: n * m].copy().reshape(n, m), system.reach
    order = spatial_order(start, reach[0] + reach[1]) if reach[0] > 0.0 else np.arange(n).astype(np.uint64)
    system = System(
        system.force, system.energy, system.guard, system.law, system.seen_from, system.moving, reach, order,
        system.frame, system.near, system.room,
    )  # fmt: skip
    fixed, end, exact = exponent == 0.0, rows[stages], (method.a, method.c, rows, stages)
    radii, bodies = around.radii, around.bodies
    encounters = (np.empty_like(radii), around.far, bodies, around.shell, around.poles)
    for i in range(n):
        put(radii[np.int64(order[i])], encounters[0][i])
    kept = np.int64(0)
    for row in rows:
        kept = max(kept, row + 1)
    rates = np.zeros((kept, y.size))
    now, reached, trial = np.empty(y.size), np.empty(y.size), np.empty(y.size)
    _moved(y, order, shape, False, now)
    _moved(f, order, shape, False, rates[0])
    pairs, scratch = empty_list(n), (np.empty(8 * n, np.uint32), np.empty(8 * n, np.uint32))
    times, states, work = np.empty(most), np.empty((most, 3, n, m)), np.empty(most)
    between, work_between = np.empty((0, 3, n, m)), np.empty(due.size)
    made, evaluations, redone, status, stop = 0, 0, 0, RUNNING, 0
    sampled, halved, first = np.int64(0), np.int64(0), np.int64(1)  # typed: literals would be compiled once more
    tried = np.empty(64)
    if fixed and h == 0.0:
        h = np.inf
    if h == 0.0:
        h, pairs = first_step(t, stops[-1] - t, now, rates, exponent, rtol, floor, trial, system, pairs)
        evaluations += 1
    while made < most and stop < stops.size and status == RUNNING:
        shortest, rejected, later, at, stands = 10.0 * _spacing(t), False, h, t, False
        h = min(stops[stop] - t, h) if fixed else max(min(h, method.longest), shortest)
        while status == RUNNING and not stands:
            if h < shortest and not fixed:
                status = TOO_SMALL
                break
            at = stops[stop] if h == stops[stop] - t else min(t + h, stops[stop])
            h = at - t
            pairs = stages_of(t, h, now, rates, reached, trial, exact, first, stages + 1, system, pairs)
            evaluations += stages
            if pairs[2] < 0:
                status = CROWDED
                break
            if not fixed:
                error = error_of(now, reached, h, estimates, rates, rows, n * m, rtol, floor, trial)
                later, passes = _controlled(h, error, exponent, rejected)
                if not passes:
                    h, rejected = later, True
                    continue
            if not (finite(reached) and finite(rates[end])):
                status = NOT_FINITE
                break
            share = 1.0
            if bodies or (radii.size and n > 1):
                share, scratch = _met(
                    t, h, now, rates[0], reached, rates[end], encounters, system, pairs, scratch
                )  # fmt: skip
            if np.isnan(share):
                status = CROWDED
                break
            if share == 1.0 and balance[0] > 0.0 and ledger[3] < PATIENCE:
                share, halved = _balanced(t, at, now, reached, balance, ledger, tried, halved, system, pairs)
            singular, share = share < 0.0, abs(share)
            least = 0.0 if fixed else ROUNDINGS * _spacing(max(abs(t), abs(at)))
            stands = share == 1.0 or (t + share * h == t if fixed else share * h <= least)
            if stands and singular:
                status = SINGULAR
            if not stands:
                h, rejected, redone = h * (max(share, 1.0 / GROWTH) if fixed else share), False, redone + 1
        if status != RUNNING:
            break
        if sampled < due.size and due[sampled] < at:
            before, between = sampled, _with_room(between, due, at)
            sampled, pairs = _sampled(
                t, h, at, now, rates, trial, due, sampled, exact, interpolant, between, work_between, system, pairs
            )  # fmt: skip
            evaluations += len(rows) - stages - 1 + sampled - before
        while sampled < due.size and due[sampled] == at:
            work_between[sampled], sampled = np.nan, sampled + 1  # the step itself is the sample
        if fixed:
            later = np.inf if at == stops[stop] else GROWTH * h
        stop += at == stops[stop]
        t, h, now, reached = at, later, reached, now
        put(rates[end], rates[0])
        times[made], work[made] = t, _record(t, now, rates[0], system, states[made])
        made += 1
    last, slope = reached, trial  # no longer needed: memory is used again
    _moved(now, order, shape, True, last)
    _moved(rates[0], order, shape, True, slope)
    between = _with_room(between, due[:sampled], np.inf)  # where steps ended there is nothing in it
    steps, passed = (times[:made], states[:made], work[:made]), (between[:sampled], work_between[:sampled])
    return status, t, last, slope, h, evaluations, redone, stop, sampled, steps, passed
