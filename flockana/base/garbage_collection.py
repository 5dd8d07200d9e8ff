"""Settings of Python's garbage collection."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager

SELDOM = 100_000
"""New objects between two looks in a program of ours: what is imported and compiled stays, and to look through it again
and again, as by default after hundreds, takes a tenth of a short command."""


@contextmanager
def relaxed_gc() -> Iterator[None]:
    """Collect garbage after a hundred thousand new objects instead of after hundreds."""
    previous_threshold = gc.get_threshold()
    gc.set_threshold(SELDOM)
    try:
        yield
    finally:
        gc.set_threshold(*previous_threshold)


def freeze_gc() -> None:
    """Exclude all present objects from garbage collection, in a process that is about to end."""
    # Else Python would look through everything that was imported twice more: a tenth of a short command.
    gc.freeze()
