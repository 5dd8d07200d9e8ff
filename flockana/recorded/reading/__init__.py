"""Readers of recordings, one file for each format."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from flockana.base.errors import FileError


@contextmanager
def opened(path: Path, wanted: str) -> Iterator[BinaryIO]:
    """Open a regular file; errors name the file and its expected content."""
    if path.exists() and not path.is_file():
        raise FileError(f"cannot read {path}: it is no regular file; expected {wanted}")
    try:
        with path.open("rb") as file:
            yield file
    except FileError:
        raise
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"cannot read {path}: {getattr(error, 'strerror', error)}; expected {wanted}") from error
