"""What a build need not do again: results kept as JSON under the digest of the code that they came from."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Any

from flockana.base.digests import sha256

ROOT = Path(__file__).resolve().parent.parent.parent
CACHE = ROOT / "site" / "cache"


@cache
def digest(folders: tuple[str, ...]) -> str:
    """Digest of every Python file in these folders of the checkout."""
    paths = (path for folder in folders for path in sorted((ROOT / folder).rglob("*.py")))
    return sha256(path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes() for path in paths)[:16]


def place(kind: str, name: str, folders: Iterable[str]) -> Path:
    """The file of a result; those that older code left are deleted."""
    path = CACHE / kind / f"{name}-{digest(tuple(folders))}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    for older in path.parent.glob(f"{name}-{'[0-9a-f]' * 16}.json"):
        if older != path:
            older.unlink()
    return path


def kept(kind: str, name: str, folders: Iterable[str], make: Callable[[], Any]) -> Any:
    """The JSON value of that name, made again where the code in `folders` has changed."""
    path = place(kind, name, folders)
    if path.exists():
        return json.loads(path.read_text(encoding="utf-8"))
    value = make()
    write(path, value)
    return value


def write(path: Path, value: Any) -> None:
    """Write a JSON value; a build that is broken off leaves no half of it."""
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(value, ensure_ascii=False), encoding="utf-8")
    partial.replace(path)
