"""numba's compiler with a cache on disk that any number of processes may fill at once.

What numba compiles it numbers, from one on in each process, in two places:

- The files of a function, by an index. Two processes that compile at once may take one number for two signatures: then
  the index of the one names the code of the other, and what is loaded later is another function. Here a file is named
  for what is in it, and is written before the index.
- The symbols of the machine code. Two closures of one name that two processes compiled, of the package, of a user or of
  numba itself, may get one symbol. A third that loads both calls the first where the second is meant: the sum over the
  pairs of another law, with other constants. Here each process counts from a number of its own.

numba looks at the time of the one file that a function is in. What it calls may be in others: here a function is as old
as the contents of its file and of all files of the package that this imports, so an edited kernel is compiled again
with all that call it.
"""

from __future__ import annotations

import hashlib
import itertools
import logging
import os
import re
import secrets
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba.core.bytecode import FunctionIdentity
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.registry import cpu_target
from numba.core.runtime import rtsys

from flockana.kernels.compiler import Compiler
from flockana.kernels.libraries import Inner, InnerResults, Outer, OuterResults
from flockana.kernels.turns import Turn

_SIGNATURES = 64  # kept of one function: in use are two or three


class NamedByContent(IndexDataCacheFile):
    """An index, and files whose names no two functions, signatures, processors or versions of a source share."""

    def save(self, key: Any, data: Any) -> None:
        """Write the file, then the index that names it; on a full disk what is compiled is used and not kept."""
        digest = hashlib.sha256(repr((key, self._source_stamp)).encode()).hexdigest()[:16]
        name = f"{self._index_name.removesuffix('.nbi')}.{digest}.nbc"
        with suppress(OSError):
            self._save_data(name, data)
            self._save_index({**self._load_index(), key: name})  # of two at once one is lost, and compiled again


class _Cache(FunctionCache):
    """numba's cache of a function, with such files."""

    suffix, _impl_class = ".code", OuterResults

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        own: IndexDataCacheFile = self._cache_file  # type: ignore[has-type]
        base = own._index_name.removesuffix(".nbi") + self.suffix
        file = getattr(sys.modules.get(function.__module__), "__file__", None)
        stamp = own._source_stamp if file is None else sources_digest(file)
        self._cache_file = NamedByContent(own._cache_path, base, stamp)
        self._of_the_package = function.__module__.startswith("flockana.")
        self.turn = Turn(own._cache_path, base)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What was compiled before, or by another process in the meantime; None, and it is our turn to compile it."""
        found = self._loaded(sig, target_context)
        if found is None and self.turn.take():
            found = self._loaded(sig, target_context)
        return found

    def _loaded(self, sig: Any, target_context: Any) -> Any:
        """What was compiled before; of the package, without loading all that numba could compile."""
        if self._of_the_package:
            rtsys.initialize(target_context)
        else:  # it may call what numba, or an extension of it, names only when that is loaded
            target_context.refresh()
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)


class _InnerCache(_Cache):
    """The same of one that kernels alone call."""

    suffix, _impl_class = ".bitcode", InnerResults


def _imported(file: Path) -> set[Path]:
    """The files of the package that a file imports, whatever it is itself."""
    root, text = Path(__file__).parents[1], file.read_text("utf-8")
    names = re.findall(r"^\s*(?:from|import) flockana\.([\w.]+)(?: import (\([^)]*\)|.+))?", text, re.MULTILINE)
    paths = set()
    for module, things in names:
        paths.add(root.joinpath(*module.split(".")).with_suffix(".py"))
        for thing in re.findall(r"\w+", things):  # it may be a module itself
            paths.add(root.joinpath(*module.split("."), thing).with_suffix(".py"))
    return {path for path in paths if path.is_file()}


@cache
def sources_digest(file: str) -> str:
    """Of the contents of a file and of all that it imports of the package, and these again.

    Parameters
    ----------
    file : str
        Its path.
    """
    known, found = set[Path](), {Path(file)}
    while found:
        known |= found
        found = {other for path in found for other in _imported(path)} - known
    digest = hashlib.sha256()
    for path in sorted(known):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _count_apart() -> None:
    """Number what is compiled from here on as no other process does."""
    FunctionIdentity._unique_ids = itertools.count(secrets.randbits(64))


_count_apart()
if hasattr(os, "register_at_fork"):  # else it goes on where its parent was, as its siblings do
    os.register_at_fork(after_in_child=_count_apart)


def dispatcher(function: Callable[..., Any], *, cache: bool, inner: bool = False, **options: Any) -> Any:
    """numba's dispatcher of a function.

    Parameters
    ----------
    function : callable
        What to compile.
    cache : bool
        Keep what is compiled on disk.
    inner : bool
        To be called by what is compiled alone: without what Python would need to call it.
    **options
        Those of `numba.njit`.
    """
    options = {"_nrt": True, **options}  # else it is as what calls it first: with references counted, or without
    if inner:
        made = numba.njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, pipeline_class=Inner, **options)(function)
    else:
        made = _at_hand(numba.njit(pipeline_class=Outer, **options)(function))
        if function.__module__.startswith("flockana."):  # what others write may write to what it is handed
            made = _for_frozen_arrays(made)
    return _cached(made, function, _InnerCache if inner else _Cache) if cache else made


def _cached(made: Any, function: Callable[..., Any], kind: type[_Cache]) -> Any:
    """The same dispatcher, which keeps on disk what it compiles."""
    try:
        made._cache = kind(function)
    except RuntimeError:  # neither beside the sources nor at home is there a folder to write to
        with suppress(RuntimeError, OSError), _cached_in(temporary_folder()):
            made._cache = kind(function)
    return _in_turn(made)


def _in_turn(made: Any) -> Any:
    """The same dispatcher, which gives its turn to others when it has compiled, or failed to."""
    if not isinstance(getattr(made, "_cache", None), _Cache) or numba.config.DISABLE_JIT:
        return made
    compiled = made.compile

    def compile_in_turn(signature: Any) -> Any:
        try:
            return compiled(signature)
        finally:
            made._cache.turn.give()

    made.compile = compile_in_turn
    return made


def _for_frozen_arrays(made: Any) -> Any:
    """The same dispatcher, which calls for arrays that cannot be written to what it compiled for those that can.

    To numba they are two types, and results are frozen: each kernel would be compiled twice and more. What callers may
    hand in to be written to is named `u` or `out`: there numba refuses a frozen array as ever.
    """
    if numba.config.DISABLE_JIT:
        return made
    names = made.py_func.__code__.co_varnames[: made.py_func.__code__.co_argcount]
    compiled, written = made.compile, {k for k, name in enumerate(names) if name in ("u", "out")}

    def compile_for(signature: Any) -> Any:
        asked, _ = numba.core.sigutils.normalize_signature(signature)
        writable = tuple(
            kind.copy(readonly=False) if isinstance(kind, numba.types.Array) and k not in written else kind
            for k, kind in enumerate(asked)
        )
        if writable == tuple(asked):
            return compiled(signature)
        found = compiled(writable)
        made._insert([kind._code for kind in asked], found, False)
        return found

    made.compile = compile_for
    return made


class _Addresses:
    """A library of compiled code that remembers where its functions are: they do not move."""

    def __init__(self, library: Any) -> None:
        self._library, self._known = library, dict[str, int]()

    def get_pointer_to_function(self, name: str) -> int:
        """The address of a function."""
        if name not in self._known:
            self._known[name] = self._library.get_pointer_to_function(name)
        return self._known[name]

    def __getattr__(self, name: str) -> Any:
        return getattr(self._library, name)


def _at_hand(made: Any) -> Any:
    """The same dispatcher, which finds what it compiled by the signature object that asks for it.

    Compiled code that is handed a function asks for its address twice in each call, by a signature that it keeps; to
    look that up by its types takes numba 0.1 ms, and to ask LLVM where it is another 0.01 ms.
    """
    if numba.config.DISABLE_JIT:  # it is the function itself
        return made
    look_up, found = made.get_compile_result, dict[int, tuple[Any, Any]]()

    def get_compile_result(signature: Any) -> Any:
        kept = found.get(id(signature))
        if kept is None or kept[0] is not signature:
            if len(found) >= _SIGNATURES:
                found.clear()
            result = look_up(signature)
            kept = found[id(signature)] = signature, result._replace(library=_Addresses(result.library))
        return kept[1]

    made.get_compile_result = get_compile_result
    return made


@contextmanager
def _cached_in(folder: Path) -> Iterator[None]:
    """Have numba cache in a folder; what it caches knows the folder later, too."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(folder)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


@cache
def temporary_folder() -> Path:
    """A folder for compiled kernels that nobody else may write to, as they are code; raises OSError if there is none.

    Where it is, is logged once: a container with a read-only install and no home compiles into it.
    """
    if not hasattr(os, "getuid"):
        raise OSError("a system without users to tell apart")
    folder = Path(tempfile.gettempdir()) / f"flockana-kernels-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o077:
        raise PermissionError(f"{folder} is not this user's alone")
    logging.getLogger("flockana").warning(
        "compiled kernels are kept in %s, as nothing else can be written; set NUMBA_CACHE_DIR for another place", folder
    )
    return folder


def inlined_type(function: Callable[..., Any]) -> Any:
    """numba's type of a function that it compiles into those that call it.

    Those of this folder give numbers and allocate nothing: the arrays that they are handed need not be counted, which
    would take longer than they do. What others write may allocate. All are inlined, however long: a loop with a call in
    it is not vectorised.

    Parameters
    ----------
    function : callable
        What is called.
    """
    own = function.__module__.startswith("flockana.kernels.")
    numba.extending.register_jitable(_nrt=not own, forceinline=True, pipeline_class=Compiler)(function)
    cpu_target.typing_context.refresh()
    return cpu_target.typing_context.resolve_value_type(function)
