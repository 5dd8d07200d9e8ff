"""Files that are whole or not there."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from flockana.base.errors import FileError


@contextmanager
def replacing(path: str | os.PathLike[str], *, remedy: str = "choose another file") -> Iterator[Path]:
    """Give a file to write, which takes the other's place when it is whole; after an error or Ctrl-C it is removed.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     target = Path(folder) / "it.txt"
    ...     with replacing(target) as partial:
    ...         _ = partial.write_text("whole")
    ...     target.read_text(), partial.exists()
    ('whole', False)
    """
    target = Path(path)
    # the suffix stays last: writers of pictures and films go by it
    partial = target.parent / f".{target.stem}.{os.getpid()}.partial{target.suffix}"
    try:
        yield partial
        os.replace(partial, target)
    except OSError as error:
        raise FileError(f"cannot write {str(target)!r}: {error.strerror or error}; {remedy}") from error
    finally:
        with suppress(OSError, ValueError):  # one that could not be written cannot be removed either
            partial.unlink(missing_ok=True)
