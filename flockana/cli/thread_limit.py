"""Number of threads of linear algebra in a command."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

_THREADS = "OPENBLAS_NUM_THREADS"


@contextmanager
def one_thread_for_matrices() -> Iterator[None]:
    """Limit OpenBLAS to one thread unless the user has set a number.

    The matrices of a small flock are done before a second thread has begun. Beside other work the two wait for each
    other: the eigenvalues of 150 agents take a hundred times as long.
    """
    if _THREADS in os.environ or "OMP_NUM_THREADS" in os.environ:
        yield
        return
    os.environ[_THREADS] = "1"
    try:
        yield
    finally:
        os.environ.pop(_THREADS, None)
