"""Version of the sources behind the numbers of stored runs.

The version is no constant that somebody must remember to raise, or a stale number could be taken for a fresh one. It
is a digest of all that decides the numbers: every source of the package up to the
scenarios and the measures of runs, without comments and docstrings, and the versions of the libraries that compute.
What only shows numbers (plots, reports, commands) and how runs are distributed is left out. So a better sentence in a
docstring keeps a store, and a changed kernel does not.
"""

import ast
import json
import platform
import re
import sys
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from importlib.util import cache_from_source
from pathlib import Path

from flockana.base.digests import sha256
from flockana.base.errors import FileError
from flockana.base.files import write_atomic

_DIGEST = re.compile("[0-9a-f]{16}")
_LIBRARIES = ("numpy", "scipy", "numba")
# files and folders of these names, wherever they are, decide no number
_SILENT = {"plots", "figures", "report", "player", "explore", "course", "cli", "falsify", "ensemble", "bibtex_entries"}
_SILENT |= {"_version", "__init__"}
_ENSEMBLE = "ensemble/one_run.py"  # of the ensemble, what makes a record


@cache
def numerics_version() -> str:
    """Return the version of all sources that determine a run's numbers, 16 hexadecimal digits."""
    root = Path(__file__).resolve().parent.parent
    sources = {str(p.relative_to(root)): p.read_bytes() for p in source_files(root)}
    return cached_digest(sources, Path(cache_from_source(__file__)).parent)


def cached_digest(sources: Mapping[str, bytes], folder: Path) -> str:
    """Return `digest_of_sources`, cached in a folder by the files' contents."""
    # To parse all sources takes most of a second, in every process; to read them, a hundredth of that. What is kept is
    # named for the files as they are, to the byte, and for what digests them. Where it cannot be kept, it is not.
    exact: list[str | bytes] = [repr((sys.version, _libraries(), Path(__file__).read_bytes()))]
    for name, file_bytes in sorted(sources.items()):
        exact += [f"\0{name}\0{len(file_bytes)}\0", file_bytes]
    cache_file = folder / f"mathematics.{sha256(exact)[:32]}.txt"
    with suppress(OSError, UnicodeDecodeError):
        if _DIGEST.fullmatch(digest := cache_file.read_text(encoding="ascii")):
            return digest
    digest = digest_of_sources(sources)
    if not sys.dont_write_bytecode and folder.is_dir():
        with suppress(FileError):
            write_atomic(cache_file, digest)
    return digest


def _libraries() -> dict[str, str]:
    return {name: version(name) for name in _LIBRARIES}


def source_files(root: Path) -> list[Path]:
    """Return the package's modules and data files that determine a run's numbers."""
    files = (p for p in root.rglob("*") if p.suffix in (".py", ".json") and "__pycache__" not in p.parts)
    pairs = ((p, p.relative_to(root).with_suffix("")) for p in files)
    return sorted(p for p, r in pairs if p == root / _ENSEMBLE or not {*r.parts} & _SILENT)


def digest_of_sources(sources: Mapping[str, bytes]) -> str:
    """Return the digest of source files by name; comments, layout and docstrings do not count."""
    # each version of Python writes the syntax tree differently; the version is part of the digest anyway
    parts: list[str | bytes] = [json.dumps([platform.python_version_tuple()[:2], _libraries()])]
    for name, file_bytes in sorted(sources.items()):
        parts += [f"\0{name}\0", _code_without_comments(file_bytes) if name.endswith(".py") else file_bytes]
    return sha256(parts)[:16]


def _code_without_comments(source: bytes) -> str:
    tree = ast.parse(source)
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and body:
            first_statement = body[0]
            if isinstance(first_statement, ast.Expr) and isinstance(first_statement.value, ast.Constant):
                del body[0]
    return ast.dump(tree)
