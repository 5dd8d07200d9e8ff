"""Sums over the pairs of a list, slab by slab of the grid that it was made in, by one thread or several.

A slab is so many cells that its pairs touch agents of itself and the next one only. All even slabs come first, then all
odd ones: no two that are summed at once touch the same agent, and what is added to an agent is added in one order. So
the bits are the same for any number of threads.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numba import prange  # so this file is imported where a run is compiled

from flockana.kernels.compiling import njit
from flockana.kernels.listed import CompiledFunction, signatures
from flockana.kernels.sweep import BLOCK


@cache
def slabs_signature() -> Any:
    """numba's type of what `sum_of_slabs` gives."""
    from numba import float64, int64, types, uint32, uint64

    matrix, vector, indices = float64[:, ::1], float64[::1], uint32[::1]
    act = types.FunctionType(signatures().act)
    shared = (float64, matrix, matrix, matrix, matrix, vector, matrix, indices, indices, int64[::1], uint64[::1])
    return float64(act, *shared)


@cache
def sum_of_slabs(threads: bool) -> CompiledFunction:
    """A term that is a sum over pairs, asked slab by slab: forces are added to u, the power is returned.

    Parameters
    ----------
    threads : bool
        Whether by as many threads as numba is told to use, or by one.
    """
    number = int(threads)  # closed over: what is compiled of the one is not taken from the cache for the other

    def summed(act, t, x, v, u, frame, numbers, panels, first, second, slabs, order):
        total, powers = 0.0 * number, np.empty(slabs.size - 1)
        for parity in range(2):
            for k in prange((slabs.size - parity) // 2):
                s = 2 * k + parity
                pairs = first[slabs[s] : slabs[s + 1]], second[slabs[s] : slabs[s + 1]]
                near, room = np.empty((2, BLOCK), np.uint64), np.empty((3, BLOCK))
                powers[s] = act(t, x, v, u, frame, numbers, panels, *pairs, pairs[0].size, order, near, room)
        for s in range(powers.size):
            total += powers[s]
        return total

    made = njit(cache=True, error_model="numpy", nogil=True, parallel=threads)(summed)
    made.compile(slabs_signature())
    made.disable_compile()
    compiled: CompiledFunction = made.dispatcher
    return compiled
