"""Runge-Kutta steps with error control over an updated list of pairs.

What a step may not leap over, and what its energies say, is looked at once it is made (`flockana.kernels.step_checks`).
"""

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import inlined
from flockana.kernels.agent_sums import finite, put_row
from flockana.kernels.runge_kutta import Step, error_of, first_step, stages_of
from flockana.kernels.verlet_list import COUNT


class Block(NamedTuple):
    """Block of consecutive integration steps: times, state vectors, rates and energies, a row per state."""

    t: Any  # times
    y: Any  # vectors
    f: Any  # their rates
    energy: Any  # energies, as far as they are known: NaN elsewhere


class Room(NamedTuple):
    """Work space of a Runge-Kutta step: stage rates, and a trial vector."""

    rates: Any
    trial: Any


class Marched(NamedTuple):
    """Result of an integration step: status, lengths of the step and of the next, evaluations."""

    status: Any
    h: Any
    later: Any
    evaluations: Any


RUNNING, TOO_SMALL, NOT_FINITE, UNLISTED, SINGULAR, FULL = range(6)  # UNLISTED: pairs, FULL: samples have no room
_SAFETY, _LEAST, _MOST = 0.9, 0.2, 10.0  # scipy's: factors of a step
GROWTH = 8.0  # times its last length may a step of RK4 grow, and by so much it is shortened at once


@inlined
def spacing(t):
    """Return the distance from a time to the next floating-point number."""
    return np.nextafter(abs(t), np.inf) - abs(t)


@inlined
def _controlled(h, error, exponent, rejected):
    """Return (length of the next step, whether the step is accepted), by the rule of scipy's solvers."""
    factor = _SAFETY * error**exponent
    if error < 1.0:
        factor = _MOST if error == 0.0 else min(_MOST, factor)
        return h * (min(1.0, factor) if rejected else factor), True
    return h * (factor if factor > _LEAST else _LEAST), False  # of an error that is no number too


@inlined
def step_of(block, k, room):
    """Return the step from row k of a block of states to row k + 1: times, states and work arrays."""
    return Step(block.t[k], block.t[k + 1] - block.t[k], block.y[k], block.y[k + 1], room.rates, room.trial)


@inlined
def march(block, k, h, ends, system, method, room, pairs):
    """Integrate from row k of a block to the next; `ends` are the step's latest end time and the final time.

    The step has the length h, if its error allows it, or, if h is 0, one that is chosen here.
    """
    y, t, stop, is_fixed, evaluations = block.y, block.t[k], ends[0], method.exponent == 0.0, 0
    first_stage, stage_end = np.int64(1), np.int64(method.stages + 1)  # typed, as in `advance`
    put_row(block.f[k], room.rates[0])
    if h == 0.0 and is_fixed:
        h = np.inf
    elif h == 0.0:
        h = first_step(ends[1] - t, Step(t, h, y[k], y[k + 1], room.rates, room.trial), method, system, pairs)
        evaluations = 1
    shortest, rejected = 10.0 * spacing(t), False
    h = min(h, stop - t) if is_fixed else max(min(h, method.longest), shortest)
    while True:
        if h < shortest and not is_fixed:
            return Marched(TOO_SMALL, h, h, evaluations)
        block.t[k + 1] = stop if h == stop - t else min(t + h, stop)
        step = step_of(block, k, room)
        stages_of(step, method, first_stage, stage_end, system, pairs)
        evaluations += method.stages
        if pairs.counts[COUNT] < 0:
            return Marched(UNLISTED, step.h, h, evaluations)
        next_step, passes = np.inf if block.t[k + 1] == stop else GROWTH * step.h, True
        if not is_fixed:
            next_step, passes = _controlled(step.h, error_of(step, method), method.exponent, rejected)
        if passes:
            break
        h, rejected = next_step, True
    end = room.rates[method.rows[method.stages]]
    put_row(end, block.f[k + 1])
    is_known = finite(step.reached) and finite(end)
    return Marched(RUNNING if is_known else NOT_FINITE, step.h, next_step, evaluations)
