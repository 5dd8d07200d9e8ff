"""Where the output goes: terminals of any encoding, readers that leave, and devices that are full."""

from __future__ import annotations

import io
import json
import sys
from typing import Any

from flockana.base.errors import FileError


class _Outlet(io.FileIO):
    """The standard output; once its reader has left, what is written is dropped and the command goes on."""

    gone = False

    def write(self, data: Any) -> int:
        """Write some bytes, or drop them all."""
        if not self.gone:
            try:
                return super().write(data) or 0
            except BrokenPipeError:
                self.gone = True
            except OSError as error:
                self.gone = True
                raise FileError(
                    f"cannot write the output: {error.strerror or error}; send it elsewhere, or make room"
                ) from error
        return len(data)


def prepare_output() -> None:
    """Make the standard output take every letter, and outlive its reader; a terminal and a test's stay as they are."""
    stream = sys.stdout
    if stream is None or stream is not sys.__stdout__ or not isinstance(stream, io.TextIOWrapper):
        return
    # a letter that the encoding lacks is told by its number, as JSON writes it too
    if stream.isatty():
        stream.reconfigure(errors="backslashreplace")
        return
    stream.flush()
    sys.stdout = io.TextIOWrapper(
        io.BufferedWriter(_Outlet(stream.fileno(), "wb", closefd=False)),
        encoding=stream.encoding,
        errors="backslashreplace",
        newline=None,
    )


def finish_output() -> None:
    """Write what is still held back; raise if that fails, and leave nothing that fails again."""
    if sys.stdout is not None:
        sys.stdout.flush()


def in_output_encoding(text: str) -> str:
    """JSON text, in which letters are escaped if the output's encoding lacks some of them.

    Examples
    --------
    >>> in_output_encoding('{"n": 7}')
    '{"n": 7}'
    """
    try:
        text.encode(getattr(sys.stdout, "encoding", None) or "utf-8")
    except UnicodeEncodeError:
        return json.dumps(json.loads(text), indent=1)
    return text
