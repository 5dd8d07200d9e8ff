"""Ctrl-C, kept for later while something is under way that it must not tear."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Keep Ctrl-C for later; processes started meanwhile never see it, not even before they can ignore it.

    Raises
    ------
    KeyboardInterrupt
        At the end, if Ctrl-C came meanwhile.

    Examples
    --------
    >>> with interrupts_held():
    ...     print("whole")
    whole
    """
    # A blocked signal alone would not do: any other thread, such as linear algebra's, takes it for the main one. And
    # where Ctrl-C is ignored, as in a background job of a shell, it stays ignored.
    came: list[int] = []
    before = signal.getsignal(signal.SIGINT)
    ours = callable(before) and threading.current_thread() is threading.main_thread()
    if ours:
        signal.signal(signal.SIGINT, lambda number, frame: came.append(number))
    try:
        with _blocked():
            yield
    finally:
        if ours:
            signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)


@contextmanager
def _blocked() -> Iterator[None]:
    """This thread, and with it what it starts, does not get the signal."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # it starts with the first process, and then unblocks the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
