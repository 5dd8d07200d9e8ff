"""Ctrl-C: deferred during critical work, and restored where libraries convert it to other errors."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker
from typing import Any

ALARMS = tuple(getattr(signal, name) for name in ("SIGALRM",) if hasattr(signal, name))  # of timeouts; not on Windows


@contextmanager
def defer_sigint(*others: int) -> Iterator[list[int]]:
    """Defer Ctrl-C, and other signals, to the end of the block; yields a list that fills when one arrives."""
    # A blocked signal would not do: any other thread, such as linear algebra's, takes it for the main one. And where
    # Ctrl-C is ignored, as in a background job of a shell, it stays ignored.
    signal_list: list[int] = []
    in_main_thread = threading.current_thread() is threading.main_thread()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, *others)} if in_main_thread else {}
    handlers = {number: handler for number, handler in handlers.items() if callable(handler)}
    for number in handlers:
        signal.signal(number, lambda number, frame: signal_list.append(number))
    try:
        yield signal_list
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number in dict.fromkeys(signal_list):
            signal.raise_signal(number)


@contextmanager
def raise_swallowed() -> Iterator[None]:
    """Raise at the end of the block any Ctrl-C or alarm that a library's callback swallowed."""
    lost: list[int] = []
    ours = threading.current_thread() is threading.main_thread()
    known: dict[int, Any] = {number: signal.getsignal(number) for number in (signal.SIGINT, *ALARMS)} if ours else {}
    handlers = {number: handler for number, handler in known.items() if callable(handler)}

    def note(number: int, frame: Any) -> None:
        lost.append(number)
        handlers[number](number, frame)
        lost.remove(number)  # it raised nothing

    for number in handlers:
        signal.signal(number, note)
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    for number in dict.fromkeys(lost):
        signal.raise_signal(number)


@contextmanager
def block_sigint() -> Iterator[None]:
    """Block Ctrl-C in processes that this thread starts inside the block."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    resource_tracker.ensure_running()  # it starts with the first process, and then unblocks the signal
    previous_mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous_mask)


@contextmanager
def restore_interrupts() -> Iterator[None]:
    """Raise KeyboardInterrupt again where compiled code or a lock turned it into another error."""
    try:
        yield
    except Exception as error:
        if _caused_by_interrupt(error):
            raise KeyboardInterrupt from error
        raise


def origin_of(error: BaseException) -> BaseException:
    """Return the first exception of a chain of causes."""
    return error if error.__cause__ is None else origin_of(error.__cause__)


def _caused_by_interrupt(error: BaseException | None) -> bool:
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    return error is not None
