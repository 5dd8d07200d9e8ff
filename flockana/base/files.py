"""Atomic file writes and path checks."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from flockana.base.errors import FileError

_MOST = 2**28  # bytes of a text that is read at once


def ensure_path(path: Any, *, action: str = "read", remedy: str = "choose another name") -> Path:
    """Return a path, or raise if the value is no path or holds characters that no file name can hold."""
    name = os.fspath(path) if isinstance(path, str | os.PathLike) else None
    if not isinstance(name, str):
        raise FileError(f"cannot {action} {path!r}: it is no path; {remedy}")
    if not name:  # a variable that is not set: files would go to wherever one happens to be
        raise FileError(f"cannot {action} '': the name is empty; {remedy}")
    if "\0" in name:  # HDF5 would take what precedes it
        raise FileError(f"cannot {action} {name!r}: null byte; {remedy}")
    return Path(name)


def ensure_target(path: Any, *, remedy: str = "choose another file") -> Path:
    """Return the target file of a path through links; raise if the target must not be replaced."""
    # A device or a pipe is left alone, and so is a link: what it points to is written.
    path_given = ensure_path(path, action="write", remedy=remedy)
    target, reason = Path(os.path.realpath(path_given)), ""
    try:
        if target.is_symlink():
            reason = "its links lead in a circle"
        elif target.exists() and not target.is_file():
            reason = "it is a folder" if target.is_dir() else "it is no regular file"
    except OSError as error:
        reason = error.strerror or str(error)
    if reason:
        raise FileError(f"cannot write {str(path_given)!r}: {reason}; {remedy}")
    return target


def ensure_folder_of(path: Any) -> Path:
    """Return a path with an existing, writable folder; raise otherwise, without creating the folder."""
    target = ensure_path(path, action="write")
    folder = target.parent
    if not folder.exists():
        raise FileError(f"cannot write {target}: there is no folder {folder}; make it first: mkdir -p {folder}")
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise FileError(f"cannot write to {folder}: {error.strerror or error}; choose another folder") from error
    return target


@contextmanager
def atomic_write(path: str | os.PathLike[str], *, remedy: str = "choose another file") -> Iterator[Path]:
    """Open a temporary file that replaces the target when complete, and is removed after an error."""
    target = ensure_target(path, remedy=remedy)
    # the suffix stays last: writers of pictures and films go by it
    partial = target.parent / f".{target.stem}.{os.getpid()}.partial{target.suffix}"
    try:
        yield partial
        os.replace(partial, target)
    except FileError:  # reported already
        raise
    except OSError as error:
        reason = (
            error if target.parent.is_dir() else f"there is no folder {target.parent}"
        )  # a writer of its own may say less
        raise FileError(f"cannot write {str(path)!r}: {error.strerror or reason}; {remedy}") from error
    finally:
        with suppress(OSError, ValueError):  # one that could not be written cannot be removed either
            partial.unlink(missing_ok=True)


def write_atomic(
    path: str | os.PathLike[str], content: str | bytes | memoryview, *, remedy: str = "choose another file"
) -> Path:
    """Write a file atomically, text as UTF-8."""
    with atomic_write(path, remedy=remedy) as partial:
        partial.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
    return Path(path)


def read_text_file(path: Any) -> str:
    """Return the UTF-8 text of a regular file; raise on devices and on files too large for a text."""
    # What is no UTF-8 raises UnicodeDecodeError, a ValueError, as what is no JSON does.
    source_path = ensure_path(path)
    try:
        if source_path.exists() and not source_path.is_file():
            reason = "it is a folder" if source_path.is_dir() else "it is no regular file"
            raise FileError(f"cannot read {source_path}: {reason}; expected a file")
        if (byte_count := source_path.stat().st_size) > _MOST:
            raise FileError(f"cannot read {source_path}: it has {byte_count} bytes; expected at most {_MOST}")
        return source_path.read_text(encoding="utf-8")
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"cannot read {source_path}: {error.strerror or error}; expected a file") from error
