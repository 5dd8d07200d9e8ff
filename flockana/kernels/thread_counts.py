"""Threads of a run: their number, and whether multithreaded code may run now.

Such code gives the same bits as its serial twin, which therefore runs wherever several threads are not safe: in a
process that was forked after threads had begun, and beside another run of this process, as not all of numba's
threading layers may be entered by two threads at once.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from multiprocessing import parent_process
from threading import Lock
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.jit import launch_threads, load_numba

_ONE_RUN = Lock()
_LIMIT: ContextVar[int | None] = ContextVar("threads of a run", default=None)


def most_threads() -> int:
    """Return how many threads numba may use: its NUMBA_NUM_THREADS, by default the number of cores."""
    launch_threads()
    return int(load_numba().config.NUMBA_NUM_THREADS)


def ensure_threads(threads: Any) -> int:
    """Return a number of threads; by default all in a main process, one in a worker."""
    if threads is None and parent_process() is None:
        return most_threads()
    is_whole_number = isinstance(threads, int) and not isinstance(threads, bool)
    if threads is None or (is_whole_number and threads == 1):
        return 1
    if not is_whole_number or not 1 <= threads <= most_threads():
        raise ArgumentError(
            f"threads = {threads!r}: expected a number from 1 to {most_threads()}, the cores that numba may use; more "
            "by NUMBA_NUM_THREADS, set before Python starts"
        )
    return int(threads)


@contextmanager
def several_threads(threads: int | None = None) -> Iterator[bool]:
    """Set numba's number of threads; yield whether code for several threads may run inside."""
    count = ensure_threads(_LIMIT.get() if threads is None else threads)
    if count < 2 or launch_threads() != os.getpid() or not _ONE_RUN.acquire(blocking=False):
        yield False
        return
    try:
        numba = load_numba()
        previous_count = numba.get_num_threads()
        numba.set_num_threads(count)
        try:
            yield True
        finally:
            numba.set_num_threads(previous_count)
    finally:
        _ONE_RUN.release()


@contextmanager
def limited_threads(threads: int | None) -> Iterator[None]:
    """Limit `several_threads` to a default number of threads inside the block."""
    token = _LIMIT.set(threads)
    try:
        yield
    finally:
        _LIMIT.reset(token)
