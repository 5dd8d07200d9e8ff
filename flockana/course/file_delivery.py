"""Safe delivery of course files into a folder: nothing edited is overwritten."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import nbformat

from flockana.base.errors import FileError
from flockana.base.files import ensure_path, write_atomic

_REMEDY = "choose another folder"


def notebook_bytes(book: Any) -> bytes:
    """Return a notebook as the bytes of its file."""
    return f"{nbformat.writes(book).rstrip()}\n".encode()


def deliver(folder: str | os.PathLike[str], files: Mapping[str, bytes]) -> list[Path]:
    """Write files into a folder, or none if one exists there with other content."""
    folder_path = ensure_path(folder, action="write to", remedy=_REMEDY)
    paths = {folder_path / name: content for name, content in files.items()}
    missing = [path for path, content in paths.items() if not _is_there(path, content)]
    try:
        for path in missing:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_atomic(path, paths[path], remedy=_REMEDY)
    except OSError as error:
        reason = getattr(error.__cause__, "strerror", None) or error.strerror or error
        raise FileError(f"cannot write all of the course to {folder_path}: {reason}; {_REMEDY}") from error
    return list(paths)


def _is_there(path: Path, content: bytes) -> bool:
    """Return whether a file with this content exists; raise on other content."""
    if not os.path.lexists(path):
        return False
    try:
        is_identical = path.is_file() and path.read_bytes() == content
    except OSError as error:
        raise FileError(f"cannot read {path}: {error.strerror or error}; {_REMEDY}") from error
    if not is_identical:
        raise FileError(
            f"{path} exists with other content: nothing is written, so that no answers are lost; "
            f"{_REMEDY}, or move it away"
        )
    return True
