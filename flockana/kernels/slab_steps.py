"""Sums of stages and checks of pair lists for large flocks, with several threads."""

import numpy as np

from flockana.jit import kernel, parallel, prange
from flockana.kernels.agent_sums import slope_along
from flockana.kernels.runge_kutta import STRIP, combine_strip

_PARTS = 64  # of the agents


@kernel
def combine_strips(y, h, weights, rates, rows, count, out):
    """Combine stage rates, as `flockana.kernels.runge_kutta.combine`, strip by strip."""
    for strip in prange((y.size + STRIP - 1) // STRIP):
        combine_strip(np.int64(strip) * STRIP, y, h, weights, rates, rows, count, out)


@kernel
def ways_between(q, reference, along, low, high):
    """Write least and greatest displacements of each group of agents per coordinate, less a common stretch."""
    n, m = q.shape
    for part in prange(_PARTS):
        begin, end = np.int64(part) * n // _PARTS, (np.int64(part) + 1) * n // _PARTS
        for c in range(m):
            lowest_value = maximum = q[0, c] - along[c] * reference[0, c]
            for i in range(begin, end):
                way = q[i, c] - along[c] * reference[i, c]
                lowest_value, maximum = way if way < lowest_value else lowest_value, way if way > maximum else maximum
            low[part, c], high[part, c] = lowest_value, maximum


parallel_combine_strips, parallel_ways_between = parallel(combine_strips), parallel(ways_between)


@kernel
def combined_by_threads(y, h, weights, rates, rows, count, out):
    """Combine stage rates with several threads, as `flockana.kernels.runge_kutta.combine`."""
    parallel_combine_strips(y, h, weights, rates, rows, count, out)


@kernel
def covered_by_threads(pairs, q, within):
    """Check a pair list with several threads, as `flockana.kernels.verlet_list.covers`."""
    reference, m = pairs.places, q.shape[1]
    stretches, low, high = np.empty(m), np.empty((_PARTS, m)), np.empty((_PARTS, m))
    for is_stretched in range(2 if pairs.reach[0] > 0.0 else 0):
        squared_value, lowest_value = 0.0, np.inf
        for c in range(m):
            stretches[c] = slope_along(reference, q, c, 1.0) if is_stretched else 1.0
            lowest_value = min(lowest_value, stretches[c])
        parallel_ways_between(q, reference, stretches, low, high)
        for c in range(m):
            low_end, high_end = low[0, c], high[0, c]
            for part in range(1, _PARTS):
                low_end, high_end = min(low_end, low[part, c]), max(high_end, high[part, c])
            squared_value += (high_end - low_end) ** 2
        if np.sqrt(squared_value) <= lowest_value * pairs.reach[0] - within:
            return True
    return False
