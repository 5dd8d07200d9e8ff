"""Choice of functions by flock size: slab by slab for large flocks, with one thread or several."""

import sys
from functools import cache
from typing import Any

import numpy as np

from flockana.jit import Kernel, callback_like, kernel, launch_threads
from flockana.kernels.cell_grid import LARGE
from flockana.kernels.runge_kutta import Work, combine
from flockana.kernels.slab_lists import listed_by_threads, listed_in_slabs
from flockana.kernels.slab_steps import combined_by_threads, covered_by_threads
from flockana.kernels.verlet_list import CROWDED, Pairs, covers, listed_anew, no_pairs, with_room


def lister(*, large: bool, several: bool = False) -> Kernel:
    """Return the pair-listing function: in slabs for large flocks, with one thread or several."""
    if not large:
        return listed_anew
    return listed_by_threads if several else listed_in_slabs


@cache
def as_callback(listing: Kernel) -> Any:
    """Return a pair-listing function as a callback for compiled code."""
    return callback_like(listing, 0, np.empty((1, 1)), 0.0, no_pairs(1, 1))


@cache
def covering(*, several: bool = False) -> Any:
    """Return `flockana.kernels.verlet_list.covers` as a callback, for one thread or for several."""
    return callback_like(covered_by_threads if several else covers, True, no_pairs(1, 1), np.empty((1, 1)), 0.0)


def parallel_twin(kernel: Kernel) -> Kernel:
    """Return the multithreaded twin of a kernel; the kernel itself without one."""
    twin: Kernel = getattr(sys.modules[kernel.__module__], f"parallel_{kernel.__name__}", kernel)
    return twin


@cache
def work_of(*, large: bool, several: bool = False) -> Work:
    """Return callbacks for listing pairs, checking lists and summing stages, by flock size and threads."""
    if several:
        launch_threads()
    y, rates, rows = np.empty(1), np.empty((1, 1)), np.empty(1, np.int64)
    return Work(
        as_callback(lister(large=large, several=several)),
        covering(several=several),
        callback_like(combined_by_threads if several else combine, None, y, 0.0, y, rates, rows, 0, y),
    )


@kernel
def _listed_by(listing, q, reach, pairs):
    """List the pairs closer than `reach` by a callback, from compiled code, and return their number."""
    return listing(q, reach, pairs)


def fill(pairs: Pairs, q: Any, reach: float, several: bool = False) -> Pairs:
    """List the pairs closer than `reach`; return the list, enlarged as needed unless CROWDED."""
    listing = as_callback(lister(large=len(q) >= LARGE, several=several))
    while _listed_by(listing, q, reach, pairs) < CROWDED:
        pairs = with_room(pairs) or pairs
    return pairs
