"""Output streams: any encoding, closed readers, full devices."""

from __future__ import annotations

import io
import json
import sys
from typing import Any

from flockana.base.errors import FileError


class _PipedOutput(io.FileIO):
    """Standard output that drops text once its reader has left."""

    gone = False

    def write(self, data: Any) -> int:
        """Write bytes; drop them once the reader has closed the pipe."""
        if not self.gone:
            try:
                return super().write(data) or 0
            except BrokenPipeError:
                self.gone = True
            except OSError as error:
                self.gone = True
                text = f"cannot write the output: {error.strerror or error}; send it elsewhere, or make room"
                raise FileError(text) from error
        return len(data)


def prepare_output() -> None:
    """Make the standard output accept every letter, and survive a closed pipe."""
    stream = sys.stdout
    if stream is None or stream is not sys.__stdout__ or not isinstance(stream, io.TextIOWrapper):
        return
    # a letter that the encoding lacks is written as its code, as in JSON
    if stream.isatty():
        stream.reconfigure(errors="backslashreplace")
        return
    stream.flush()
    piped = io.BufferedWriter(_PipedOutput(stream.fileno(), "wb", closefd=False))
    sys.stdout = io.TextIOWrapper(piped, encoding=stream.encoding, errors="backslashreplace")


def finish_output() -> None:
    """Flush the standard output; raise if it cannot be written."""
    if sys.stdout is not None:
        sys.stdout.flush()


def in_output_encoding(text: str) -> str:
    """Return JSON text with letters escaped that the output's encoding lacks.

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
