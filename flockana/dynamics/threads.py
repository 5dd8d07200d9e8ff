"""How many threads compiled code may use."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock
from typing import Any

from flockana.base.checks import ensure_count
from flockana.base.errors import ArgumentError


def ensure_threads(threads: Any) -> int:
    """A number of threads that there can be.

    Raises
    ------
    ArgumentError
        If there are not so many.

    Examples
    --------
    >>> ensure_threads(1)
    1
    """
    number = ensure_count("threads", threads)
    if number > 1:
        from numba import config

        if _process.cache_info().currsize and _process() != os.getpid():
            raise ArgumentError(
                f"threads = {number}: the process that this one was forked from has used threads, and OpenMP would end "
                "it; expected 1, or processes that are spawned"
            )
        if number > config.NUMBA_NUM_THREADS:
            raise ArgumentError(
                f"threads = {number}: expected 1 to {config.NUMBA_NUM_THREADS}, the number of cores, or what the "
                "variable NUMBA_NUM_THREADS says instead"
            )
    return number


def ensure_one_thread(law: Any, threads: int) -> None:
    """Raise if a run that is not compiled is to have more.

    Raises
    ------
    ArgumentError
        If so.
    """
    if threads > 1:
        raise ArgumentError(
            f"threads = {threads}: this run of {type(law).__name__} is not compiled; expected 1, or a law that is "
            "compiled and one of the methods DOP853, RK45, RK23 and RK4"
        )


@cache
def _process() -> int:
    """The process that used threads first."""
    return os.getpid()


@cache
def _turn() -> Lock:
    """One run after the other: not every threading layer of numba takes calls from two threads at once."""
    return Lock()


@contextmanager
def threads_of_numba(threads: int) -> Iterator[None]:
    """Have numba use so many threads for what this thread calls; another that does so as well waits.

    Parameters
    ----------
    threads : int
        1 for none beside this one.
    """
    if threads == 1:
        yield
        return
    import numba

    _process()
    with _turn():
        before = numba.get_num_threads()
        numba.set_num_threads(threads)
        try:
            yield
        finally:
            numba.set_num_threads(before)
