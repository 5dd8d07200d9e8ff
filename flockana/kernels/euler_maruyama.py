"""Euler-Maruyama steps of a compiled law: q + h p + ½ h² u, p + h u + Δw, many in one call."""

from __future__ import annotations

import numpy as np

from flockana.jit import kernel
from flockana.kernels.runge_kutta import rate_of
from flockana.kernels.verlet import COUNT


@kernel
def euler_maruyama_steps(t, h, y, kicks, wanted, system, pairs, out):
    """Write (q, p, u) after the steps wanted, numbered from 1; returns whether the pairs fit into the list.

    `kicks` has a row of changes of the velocities for each step. y is overwritten; once it is not finite it stays so.
    """
    (n, m), row = (system.order.size, system.frame.shape[1]), 0
    size, f = n * m, np.empty(y.size)
    for k in range(kicks.shape[0]):
        finite = True
        for i in range(2 * size):
            finite = finite and np.isfinite(y[i])
        if finite:
            rate_of(t + k * h, y, f, system, pairs)
            if pairs.counts[COUNT] < 0:
                return False
        else:
            f[:] = np.nan
        for i in range(size):
            before, after = y[size + i], y[size + i] + h * f[size + i]
            y[i] += 0.5 * h * (before + after)
            y[size + i] = after + kicks[k, i]
        if wanted[row] == k + 1:
            for i in range(size):
                a, c = i // m, i % m
                out[0, row, a, c], out[1, row, a, c], out[2, row, a, c] = y[i], y[size + i], f[size + i]
            row += 1
    return True
