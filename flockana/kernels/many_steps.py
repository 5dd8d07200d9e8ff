"""Many steps of a compiled law in one call; each is checked, and repeated with a shorter one on failure."""

from typing import NamedTuple

import numpy as np

from flockana.jit import inlined, kernel, parallel, prange
from flockana.kernels.adaptive_steps import FULL, RUNNING, SINGULAR, UNLISTED, march, step_of
from flockana.kernels.cell_grid import LARGE
from flockana.kernels.runge_kutta import energy_of, frame_at, interpolated, rate_of, stages_of
from flockana.kernels.step_checks import IN_VAIN, PATIENCE, checked
from flockana.kernels.verlet_list import COUNT

AT_ONCE = 50_000_000  # agents and pairs in all evaluations of one call, some tenths of a second: then signals are heard
_PARTS = 64  # of a large flock, whose states are written by all threads


class Advanced(NamedTuple):
    """Numbers that `advance` returns: status, steps, evaluations."""

    steps: int  # number of accepted steps
    status: int  # status of the last step, which says why the block ends
    h: float  # length of the next step, or of the one that failed
    evaluations: int
    redone: int  # number of steps that were made again
    samples: int  # number of the times due that are passed, or that need room if no step had it


@inlined
def _write_states(y, f, order, frame, begin, end, out):
    """Write positions, velocities and accelerations of some agents, under the agents' own numbers."""
    n, m = order.size, frame.shape[1]
    for i in range(begin, end):
        agent = np.int64(order[i])
        for c in range(m):
            out[0, agent, c] = y[i * m + c] + frame[0, c]
            out[1, agent, c] = y[n * m + i * m + c] + frame[1, c]
            out[2, agent, c] = f[n * m + i * m + c]


@inlined
def _work_of(y, size):
    """Return the work done, which is the state vector's last number; NaN if the vector holds none."""
    return y[size] if y.size > size else np.nan


@kernel
def record(block, order, view, states, work):
    """Write states and work at the ends of a block's first steps, in the original order of agents.

    The room is numpy's, for large pages (`flockana.kernels.pair_sums.forces`).
    """
    frame, n, m = np.empty((2, view[1].size)), order.size, view[1].size
    parts = _PARTS if n >= LARGE else 1
    for k in range(work.size):
        frame_at(block.t[k + 1], view, frame)
        y, f, out = block.y[k + 1], block.f[k + 1], states[k]
        for part in prange(parts):
            _write_states(y, f, order, frame, np.int64(part) * n // parts, (np.int64(part) + 1) * n // parts, out)
        work[k] = _work_of(y, 2 * n * m)


parallel_record = parallel(record)


@inlined
def _sampled(step, due, method, states, work, system, pairs):
    """Write the samples (q, p, u) due within a step, in the original order of agents."""
    slope = np.empty(step.y.size)
    stages_of(step, method, np.int64(method.stages + 1), np.int64(len(method.rows)), system, pairs)
    for k in range(due.size):
        interpolated((due[k] - step.t) / step.h, step, method, system.work.combine)
        rate_of(due[k], step.trial, slope, system, pairs)  # and writes the frame at that time
        n, m = system.order.size, system.frame.shape[1]
        _write_states(step.trial, slope, system.order, system.frame, 0, n, states[k])
        work[k] = _work_of(step.trial, 2 * n * m)


@kernel
def advance(system, method, block, room, h, lists, stops, samples, judged):
    """Fill a block with accepted steps up to the last of `stops`, from its first row; return the fields of `Advanced`.

    The first step has the length h, or, if that is 0, one that is chosen here. `lists` are those of the integrator and
    of the checks; samples are (times that are due, states, work), work being NaN where a step ends.
    """
    (pairs, near_pairs), (due_times, states, work_series) = lists, samples
    has_energy, evaluations, redone_steps, status, stop, sampled = judged.rules.energetic, 0, 0, RUNNING, 0, 0
    agents, steps = (
        system.order.size,
        np.int64(0),
    )  # typed: of a literal, all that is called would be compiled once more
    while steps + 1 < block.t.size and stop < stops.size and evaluations * (agents + pairs.counts[COUNT]) < AT_ONCE:
        step_result = march(block, steps, h, (stops[stop], stops[-1]), system, method, room, pairs)
        status, evaluations, block_time = step_result.status, evaluations + step_result.evaluations, block.t[steps + 1]
        if status != RUNNING:
            h = h if status == UNLISTED else step_result.h
            break
        if has_energy and judged.ledger[IN_VAIN] < PATIENCE:
            for row in range(steps, steps + 2):
                if row > steps or np.isnan(block.energy[row]):
                    block.energy[row] = energy_of(block.t[row], block.y[row], system, pairs)
        shorter_step, is_singular = checked(block, steps, judged, system.seen_from, pairs, near_pairs)
        if is_singular:
            h, status = step_result.h, SINGULAR
            break
        if shorter_step > 0.0:
            h, redone_steps = shorter_step, redone_steps + 1
            continue
        before = sampled
        while sampled < due_times.size and due_times[sampled] < block_time:
            sampled += 1
        is_known = sampled
        while is_known < due_times.size and due_times[is_known] == block_time:
            is_known += 1  # the step itself is the sample
        if is_known > len(states):
            h, status, sampled = step_result.h, FULL, (before if steps else is_known)
            break
        work_series[sampled:is_known] = np.nan
        if sampled > before:
            step, inner_times = step_of(block, steps, room), due_times[before:sampled]
            _sampled(step, inner_times, method, states[before:sampled], work_series[before:sampled], system, pairs)
            evaluations += len(method.rows) - method.stages - 1 + sampled - before
            if pairs.counts[COUNT] < 0:
                h, status, sampled = step_result.h, UNLISTED, before
                break
        sampled = is_known
        stop += block_time == stops[stop]
        h, steps = step_result.later, steps + 1
    return steps, status, h, evaluations, redone_steps, sampled
