"""How often Python looks for garbage."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

SELDOM = (100_000, 20, 20)
"""Thresholds of a program of ours: what is imported and compiled stays, and to look through it again and again, as by
the default of 700 new objects, takes a tenth of a short command."""


@contextmanager
def garbage_seldom_sought() -> Iterator[None]:
    """Look for garbage after a hundred thousand new objects, not after hundreds.

    Examples
    --------
    >>> before = gc.get_threshold()
    >>> with garbage_seldom_sought():
    ...     gc.get_threshold()
    (100000, 20, 20)
    >>> gc.get_threshold() == before
    True
    """
    before = gc.get_threshold()
    gc.set_threshold(*SELDOM)
    try:
        yield
    finally:
        gc.set_threshold(*before)
