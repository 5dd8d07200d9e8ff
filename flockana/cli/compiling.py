"""A line on the terminal while kernels are compiled, which happens once and takes up to a minute."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from inspect import unwrap

_EVERY = 2.0  # seconds between looks; two in a row within the compiler are no accident
_TEXT = "compiling for this machine, which happens once and takes up to a minute ..."


@contextmanager
def announce_compiling() -> Iterator[None]:
    """Print a line on a terminal's error stream if the main thread compiles for some seconds."""
    if not sys.stderr.isatty():
        yield
        return
    over = threading.Event()
    watcher = threading.Thread(target=_watch, args=(threading.get_ident(), over), daemon=True)
    watcher.start()
    try:
        yield
    finally:
        over.set()


def _watch(thread: int, over: threading.Event) -> None:
    seen = 0
    while not over.wait(_EVERY):
        seen = seen + 1 if in_compiler(thread) else 0
        if seen == 2:
            sys.stderr.write(f"{_TEXT}\n")
            return


def in_compiler(thread: int) -> bool:
    """Return whether a thread compiles a kernel."""
    jit = sys.modules.get("flockana.jit")  # not imported for this: most commands need no compiler
    compile_functions = [unwrap(each).__code__ for each in (jit.Kernel._compile, jit.callback)] if jit else []
    frame = sys._current_frames().get(thread)
    while frame is not None:
        if frame.f_code in compile_functions:
            return True
        frame = frame.f_back
    return False
