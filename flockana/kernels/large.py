"""Choice of functions by flock size: slab by slab for large flocks, with one thread or several."""

import sys
from functools import cache
from typing import Any

import numpy as np

from flockana.jit import Kernel, callback_like, launch_threads
from flockana.kernels.grid import LARGE
from flockana.kernels.runge_kutta import Work, combine
from flockana.kernels.slab_lists import listed_by_threads, listed_in_slabs
from flockana.kernels.slab_steps import combined_by_threads, covered_by_threads
from flockana.kernels.verlet import CROWDED, Pairs, covers, listed_anew, no_pairs, with_room


def lister(*, large: bool, several: bool = False) -> Kernel:
    """Return the pair-listing function: in slabs for large flocks, with one thread or several."""
    if not large:
        return listed_anew
    return listed_by_threads if several else listed_in_slabs


@cache
def as_callback(listing: Kernel) -> Any:
    """Return a pair-listing function as a callback for compiled code."""
    return callback_like(listing, 0, np.empty((1, 1)), 0.0, no_pairs(1, 1))


def parallel_twin(kernel: Kernel) -> Kernel:
    """Return the multithreaded twin of a kernel; the kernel itself without one."""
    twin: Kernel = getattr(sys.modules[kernel.__module__], f"parallel_{kernel.__name__}", kernel)
    return twin


@cache
def work_of(*, large: bool, several: bool = False) -> Work:
    """Return the step functions other than the law, by flock size and number of threads."""
    covering, combining = (covered_by_threads, combined_by_threads) if several else (covers, combine)
    if several:
        launch_threads()
    y, rates, rows = np.empty(1), np.empty((1, 1)), np.empty(1, np.int64)
    return Work(
        as_callback(lister(large=large, several=several)),
        callback_like(covering, True, no_pairs(1, 1), rates, 0.0),
        callback_like(combining, None, y, 0.0, y, rates, rows, 0, y),
    )


def fill(pairs: Pairs, q: Any, reach: float, several: bool = False) -> Pairs:
    """List the pairs closer than `reach`; return the list, enlarged as needed unless CROWDED."""
    while lister(large=len(q) >= LARGE, several=several)(q, reach, pairs) < CROWDED:
        pairs = with_room(pairs) or pairs
    return pairs
