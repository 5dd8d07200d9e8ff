"""Fixed steps of a compiled law as a map: many unchecked steps in one call."""

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import inlined, kernel
from flockana.kernels.runge_kutta import rate_of


class Coefficients(NamedTuple):
    """Coefficients of a fixed-step method, its step, and the range of pairs."""

    a: Any  # weights of the stages, and in its last row those of the step
    c: Any  # their times, as shares of the step
    stages: Any
    one: Any  # whether it has one stage, and positions q + h p + f h² u
    lead: Any  # f
    h: Any
    reach: Any


@inlined
def _combine(y, h, weights, count, rates, out):
    """Write y + h Σ weights_j K_j of positions and velocities, K_j the stage rates, into `out`."""
    for i in range(out.size - 1):
        total = 0.0
        for j in range(count):
            if weights[j] != 0.0:
                total += weights[j] * rates[j, i]
        out[i] = y[i] + h * total


@inlined
def _finite(y):
    is_known = True
    for i in range(y.size - 1):
        is_known = is_known and np.isfinite(y[i])
    return is_known


@kernel
def fixed_steps(times, y, kicks, wanted, method, system, pairs, out):
    """Write (q, p, u) after the requested steps, numbered from 1; return whether the pair list sufficed.

    `times` are those at which steps begin; `kicks` has a row of changes of the velocities for each step, or none. Pairs
    are listed anew for each input, not by `system`, so that the order of sums hangs on the positions alone. y is
    overwritten; once it is
    not finite it stays so.
    """
    (n, m), row, h, reach = (system.order.size, system.frame.shape[1]), 0, method.h, method.reach
    size, stages, has_noise = n * m, method.stages, kicks.size > 0
    rates, trial, u = np.zeros((stages, y.size)), np.zeros(y.size), np.empty(size)
    for k in range(wanted[-1]):
        for s in range(stages):
            if s == 0:
                for i in range(2 * size):
                    trial[i] = y[i]
            else:
                _combine(y, h, method.a[s], s, rates, trial)
                if has_noise:
                    for i in range(size):
                        trial[size + i] += kicks[k, i]
            if _finite(trial):
                if reach > 0.0 and system.work.listed(trial[:size].reshape(n, m), reach, pairs) < 0:
                    return False
                rate_of(times[k] + method.c[s] * h, trial, rates[s], system, pairs)
            else:
                rates[s] = np.nan
        for i in range(size):
            total = 0.0
            for j in range(stages):
                if method.a[stages, j] != 0.0:
                    total += method.a[stages, j] * rates[j, size + i]
            u[i] = total
        if method.one:
            for i in range(size):
                before, after = y[size + i], y[size + i] + h * u[i]
                y[i] = y[i] + h * after if method.lead == 1.0 else y[i] + h * before + (method.lead * h * h) * u[i]
                y[size + i] = after
        else:
            _combine(y, h, method.a[stages], stages, rates, trial)
            for i in range(size):
                y[i], y[size + i] = trial[i], y[size + i] + h * u[i]
        if has_noise:
            for i in range(size):
                y[size + i] += kicks[k, i]
        if wanted[row] == k + 1:
            for i in range(size):
                a, c = i // m, i % m
                out[0, row, a, c], out[1, row, a, c], out[2, row, a, c] = y[i], y[size + i], u[i]
            row += 1
    return True
