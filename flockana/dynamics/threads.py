"""How many threads compiled code may use."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
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


@contextmanager
def threads_of_numba(threads: int) -> Iterator[None]:
    """Have numba use so many threads, of this thread's own calls only.

    Parameters
    ----------
    threads : int
        1 for none beside this one.
    """
    if threads == 1:
        yield
        return
    import numba

    before = numba.get_num_threads()
    numba.set_num_threads(threads)
    try:
        yield
    finally:
        numba.set_num_threads(before)
