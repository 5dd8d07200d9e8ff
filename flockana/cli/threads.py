"""Number of threads of linear algebra in a command."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

_THREADS = "OPENBLAS_NUM_THREADS"
_SAID = (_THREADS, "OMP_NUM_THREADS")


@contextmanager
def one_thread_for_matrices() -> Iterator[None]:
    """Limit OpenBLAS to one thread unless the user has set a number.

    The matrices of a small flock are done before a second thread has begun. Beside other work the two wait for each
    other: the eigenvalues of 150 agents take a hundred times as long.
    """
    said = any(name in os.environ for name in _SAID)
    if not said:
        os.environ[_THREADS] = "1"
    try:
        yield
    finally:
        if not said:
            os.environ.pop(_THREADS, None)
