"""Fallback folder for matplotlib's files where the home cannot be written, as in containers."""

from __future__ import annotations

import os
import stat
import sys
import tempfile
from pathlib import Path


def prepare_home() -> None:
    """Give matplotlib a private temporary folder if its own cannot be written; child processes inherit it.

    By itself it takes a new one each time, which costs seconds, and says so in three lines. What the user has chosen
    stays, and where there is no such folder either, matplotlib tells.
    """
    if "MPLCONFIGDIR" in os.environ or not sys.platform.startswith("linux"):
        return
    home = Path(os.path.expanduser("~"))
    folders = os.environ.get("XDG_CONFIG_HOME") or home / ".config", os.environ.get("XDG_CACHE_HOME") or home / ".cache"
    if all(_writable(Path(folder) / "matplotlib") for folder in folders):
        return
    folder = Path(tempfile.gettempdir()) / f"flockana-matplotlib-{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
    except OSError:
        return
    # settings are read from there: nobody else may write them
    if stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid() and not status.st_mode & 0o077:
        os.environ["MPLCONFIGDIR"] = str(folder)


def _writable(folder: Path) -> bool:
    """Return whether a folder can be written or created."""
    existing_path = next(path for path in (folder, *folder.absolute().parents) if os.path.lexists(path))
    return existing_path.is_dir() and os.access(existing_path, os.W_OK | os.X_OK)
