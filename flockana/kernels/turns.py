"""Whose turn it is to compile a function: of several processes that want it one compiles, the others load what it made.

A turn is a lock on one byte of a file beside the cache, which the system takes back when its process ends, however it
ends. No turn is waited for in a circle: who compiles a function wants turns of those that it calls alone. Where there
are no such locks, everyone compiles at once, as without.
"""

from __future__ import annotations

import hashlib
import os
import time
from contextlib import suppress
from functools import cache
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

_PATIENCE = 120.0  # seconds: a process that was stopped in its turn keeps nobody waiting for ever
_LOOK = 0.01  # seconds between two looks


class Turn:
    """Of one function.

    Parameters
    ----------
    folder : str
        Of the cache.
    name : str
        Of the function there.
    """

    def __init__(self, folder: str, name: str) -> None:
        self._folder, self._taken = folder, False
        self._byte = int.from_bytes(hashlib.sha256(name.encode()).digest()[:7])

    def take(self) -> bool:
        """Wait for the turn; whether it was had."""
        with suppress(OSError):
            file, until = _file(self._folder), time.monotonic() + _PATIENCE
            while fcntl is not None and not self._taken and time.monotonic() < until:
                try:
                    fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, self._byte)
                    self._taken = True
                except BlockingIOError:  # another process has it
                    time.sleep(_LOOK)
        return self._taken

    def give(self) -> None:
        """Let others have it."""
        if self._taken:
            self._taken = False
            with suppress(OSError):  # what was compiled is as good
                fcntl.lockf(_file(self._folder), fcntl.LOCK_UN, 1, self._byte)


@cache
def _file(folder: str) -> int:
    """The file of a folder's turns, open as long as the process lives: to close it would give all of them."""
    return os.open(Path(folder) / "turns.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
