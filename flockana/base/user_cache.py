"""Cache of plain data in the user's cache folder, valid for one installation."""

import json
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from flockana.base.digests import sha256
from flockana.base.errors import FileError
from flockana.base.files import write_atomic

ROOT = Path(__file__).parents[1]  # of the package


def kept_data(name: str, compute: Callable[[], Any]) -> Any:
    """Return a function's result, read from the user's cache folder until a file of the package changes."""
    path = None
    with suppress(OSError, ValueError, RuntimeError):  # RuntimeError: there is no home folder
        folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "flockana" / "lists"
        path = folder / f"{name}-{_installation()}.json"
        return json.loads(path.read_text("utf-8"))
    data = compute()
    if path is not None:
        with suppress(OSError, FileError):
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            for old_path in path.parent.glob(f"{name}-*.json"):
                old_path.unlink(missing_ok=True)
            write_atomic(path, json.dumps(data))
    return data


def _installation() -> str:
    """Return a digest of the names, sizes and times of the package's files."""
    files = ((path, path.stat()) for path in sorted(ROOT.rglob("*.*")) if path.suffix != ".pyc")
    fingerprint = [sys.version, *((str(path), stat.st_size, stat.st_mtime_ns) for path, stat in files)]
    return sha256([repr(fingerprint)])[:16]
