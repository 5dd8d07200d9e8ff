"""Numba decorators that load numba at the first call, and the folder of compiled code.

Kernels load numba when they first compute: a list of scenarios needs no compiler. Compiled code lies in a folder of the
user's own, by the contents of the source file and of all package files that it imports, so that an edited kernel is
compiled again with all its callers. numba numbers files and symbols from one on in each process: so each cached
function is a module's own, of a name and a signature that no other function has, and one process compiles at a time.
"""

import functools
import logging
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from functools import cache
from multiprocessing import parent_process
from pathlib import Path
from threading import RLock, Timer
from types import FunctionType
from typing import Any

import numpy as np

from flockana.base.digests import sha256
from flockana.base.garbage_collection import relaxed_gc
from flockana.base.interrupts import origin_of, raise_swallowed
from flockana.base.progress import show_part

try:
    import fcntl
except ImportError:  # Windows: there every process compiles what it needs
    fcntl = None  # type: ignore[assignment]

COMPILES = "flockana compiles for this machine, which happens once and takes up to a minute; first {} ..."
WRITTEN = ("u", "out")  # arguments that a kernel writes to: no frozen array may stand for them
prange = range  # of one thread (`Parallel`)
_NO_C, _NO_PYTHON = {"no_cfunc_wrapper": True}, {"no_cpython_wrapper": True}  # entries that numba adds to each function
_PATIENCE, _LOOK = 600.0, 0.02  # seconds: of a wait for another process, and between two looks
_FORM = b"2"  # another if this file comes to compile otherwise: it is no source of kernels itself
_SILENT = 3.0  # seconds of compiling that go without a word
_UNUSED = 60 * 86400.0  # seconds after which a folder of compiled code is removed
_ONE = RLock()  # one thread compiles at a time
_ANNOUNCED: list[str] = []  # the kernel that was named as compiled
_OPEN: list[Any] = []  # dispatchers that compile for new types, until all is compiled


class Kernel:
    """Function that numba compiles at its first call."""

    def __init__(self, function: Callable[..., Any], kept: bool, options: dict[str, Any]) -> None:
        functools.update_wrapper(self, function)
        self.__name__, self.__qualname__ = function.__name__, function.__qualname__
        self.function, self.kept, self.options, self._thaws = function, kept, options, False
        self._compiled: Callable[..., Any] | None = None
        self._dispatcher: Any = None

    @property
    def dispatcher(self) -> Any:
        """The function as a dispatcher of numba.

        No `cached_property`: in Python 3.11 that holds a lock of its own, which a thread that compiles waits for.
        """
        if self._dispatcher is None:
            with _ONE:
                self._dispatcher = self._dispatcher or self._decorated()
        return self._dispatcher

    def _decorated(self) -> Any:
        return _with_cache(self.function, self.kept, lambda numba, cache: numba.njit(cache=cache, **self.options))

    @property
    def targetoptions(self) -> dict[str, Any]:
        """Options of `numba.njit`, read by numba where it may inline a call."""
        return self.options

    @property
    def py_func(self) -> Callable[..., Any]:
        """Original Python function, before compilation."""
        return self.function

    def __call__(self, *arguments: Any) -> Any:
        """Run the compiled function; read-only arrays are passed as writable views."""
        try:
            if self._compiled is not None and not self._thaws:
                try:
                    return self._compiled(*arguments)
                except TypeError:  # of another type, or frozen
                    pass
            plain_arguments = self._thawed(arguments)
            if self._compiled is not None:
                with suppress(TypeError):
                    return self._compiled(*plain_arguments)
            self._compile(plain_arguments)
            return self._compiled(*plain_arguments)  # type: ignore[misc]
        except SystemError as error:  # of an alarm while numba made a tuple of arrays
            raise origin_of(error) from None

    def _thawed(self, arguments: tuple[Any, ...]) -> list[Any]:
        """Return the arguments with writable views of read-only arrays, and record that such arrays occur."""
        code, plain_arguments = self.function.__code__, list(arguments)
        for k, argument in enumerate(arguments):
            if type(argument) is np.ndarray and not argument.flags.writeable and code.co_varnames[k] not in WRITTEN:
                plain_arguments[k], self._thaws = thawed(argument), True
        return plain_arguments

    def _compile(self, arguments: list[Any]) -> None:
        numba, dispatcher = load_numba(), self.dispatcher
        if hasattr(dispatcher, "compile"):  # else NUMBA_DISABLE_JIT is set
            types = tuple(map(numba.typeof, arguments))
            with compiling(_mark(self.function, types) if self.kept else None, self.function.__name__):
                _opened(dispatcher).compile(types)
            _ensure_plain(self.function.__name__, dispatcher.overloads[types].signature.return_type)
            if any(_holds_callback(numba, kind) for kind in types):
                dispatcher = _signal_safe(dispatcher)
        self._compiled = dispatcher

    def __reduce__(self) -> Any:
        """Pickle a module's own function by its name."""
        return self.__qualname__ if _named(self) else (type(self), (self.function, self.kept, self.options))


def _holds_callback(numba: Any, kind: Any) -> bool:
    """Return True for the type of a callback, or of a tuple with one."""
    parts = getattr(kind, "types", ())
    return isinstance(kind, numba.types.FunctionType) or any(_holds_callback(numba, part) for part in parts)


def _signal_safe(dispatcher: Callable[..., Any]) -> Callable[..., Any]:
    """Return a wrapper of a numba function that loses no alarm or Ctrl-C while numba unpacks callbacks."""

    def call(*arguments: Any) -> Any:
        with raise_swallowed():
            try:
                return dispatcher(*arguments)
            except TypeError as error:  # of other types; or what numba makes of the handler's own exception
                refusal = error
        raise refusal

    return call


def _ensure_plain(name: str, result: Any) -> None:
    """Raise on named tuples in a kernel's result: an alarm while numba builds one kills the process."""
    if hasattr(result, "instance_class"):
        raise TypeError(f"{name} returns {result}: expected numbers, as kernels that Python calls write into arrays")
    for component in getattr(result, "types", ()):
        _ensure_plain(name, component)


class Inlined(Kernel):
    """Function that is compiled into the kernels that call it; called from Python it runs interpreted."""

    def __call__(self, *arguments: Any) -> Any:
        """Run the function in the interpreter."""
        return self.function(*arguments)


def njit(*, cache: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Kernel]:
    """Return a decorator like `numba.njit`, which loads numba at the first call."""
    return lambda function: Kernel(function, cache, options)


def register_jitable(function: Callable[..., Any]) -> Inlined:
    """Return a function that kernels can call, compiled into them."""
    return Inlined(function, False, {"forceinline": True, "error_model": "numpy", **_NO_C, **_NO_PYTHON})


def inlined(function: Callable[..., Any]) -> Inlined:
    """Return a function that is written into the source of its single calling kernel.

    Each function that is compiled by itself costs some tenths of a second.
    """
    return Inlined(function, False, {"inline": "always"})


def kernel(function: Callable[..., Any]) -> Kernel:
    """Return a kernel cached on disk, with options shared by all kernels."""
    return Kernel(function, True, {"error_model": "numpy", "nogil": True, **_NO_C})


class Subroutine(Kernel):
    """Kernel that kernels call: compiled without the entry by which Python calls it."""

    _for_python: Kernel | None = None

    def __call__(self, *arguments: Any) -> Any:
        """Run the function, compiled once more for Python, as in tests."""
        if self._for_python is None:
            function = _renamed(self.function, self.function.__name__)
            self._for_python = Kernel(function, False, self.options | {"no_cpython_wrapper": False})
        return self._for_python(*arguments)


def subroutine(function: Callable[..., Any]) -> Kernel:
    """Return a kernel, kept on disk, for other kernels to call."""
    return Subroutine(function, True, {"error_model": "numpy", "nogil": True, **_NO_C, **_NO_PYTHON})


class Parallel(Kernel):
    """Multithreaded twin of a kernel: the same text with numba's `prange`."""

    def _decorated(self) -> Any:
        launch_threads()
        self.function = _renamed(self.function, self.function.__name__, prange=load_numba().prange)
        return super()._decorated()


def _renamed(function: Callable[..., Any], name: str, **known: Any) -> Callable[..., Any]:
    """Return a function with the same text, another name, and changed module globals."""
    code = function.__code__.replace(co_name=name, co_qualname=name)
    return FunctionType(code, function.__globals__ | known if known else function.__globals__, name)


def parallel(kernel: Kernel) -> Kernel:
    """Return a kernel's multithreaded twin; its module must define ``parallel_`` plus the kernel's name.

    Files and symbols of compiled code bear names of functions: it has one of its own.
    """
    options = kernel.options | {"parallel": True, "no_cpython_wrapper": False}
    return Parallel(_renamed(kernel.function, f"parallel_{kernel.__name__}"), kernel.kept, options)


@cache
def callback(kernel: Kernel, signature: Any) -> Any:
    """Return a kernel compiled for one signature, as a function that compiled code can take as an argument.

    Code that calls it does not contain it, as it contains each kernel that it calls by name: what large functions
    share is compiled once.
    """
    if load_numba().config.DISABLE_JIT:
        return kernel.function
    with compiling(_mark(kernel.function, signature), kernel.function.__name__):
        options = {"error_model": "numpy", "nogil": True}
        return _with_cache(kernel.function, True, lambda numba, cache: numba.cfunc(signature, cache=cache, **options))


def callback_like(kernel: Kernel, result: Any, *arguments: Any) -> Any:
    """Return `callback` for the signature of an example result and example arguments."""
    numba = load_numba()
    if numba.config.DISABLE_JIT:
        return kernel.function
    return callback(kernel, numba.typeof(result)(*map(numba.typeof, arguments)))


def thawed(array: Any) -> Any:
    """Return a view of an array that numba types as writable, so that one compiled version serves all arrays."""
    return np.asarray(_Memory(array))


class _Memory:
    """Memory of an array, as numpy's array interface."""

    def __init__(self, array: Any) -> None:
        self.array = array  # kept alive by the view's base
        layout = array.__array_interface__
        self.__array_interface__ = {**layout, "data": (layout["data"][0], False)}


@cache
def load_numba() -> Any:
    """Import numba, teach it to type kernels as their dispatchers, and return it."""
    import numba
    from numba.extending import typeof_impl

    @typeof_impl.register(Kernel)  # type: ignore[untyped-decorator]
    def typeof_kernel(kernel: Kernel, context: Any) -> Any:
        return numba.typeof(_opened(kernel.dispatcher))

    return numba


@cache
def launch_threads() -> int:
    """Start numba's threads, needed before parallel code can be loaded; return the process id."""
    numba, policy = load_numba(), "OMP_WAIT_POLICY"
    with _ONE:
        is_set = policy in os.environ
        os.environ.setdefault(policy, "passive")  # threads that wait in a loop take the cores that others need
        numba.config.reload_config()  # NUMBA_NUM_THREADS may be set after numba's import, but not from now on
        numba.get_num_threads()
        if not is_set:
            del os.environ[policy]
    return os.getpid()


@contextmanager
def pause_compiling() -> Iterator[None]:
    """Pause compilation in other threads, as numba raises if NUMBA_NUM_THREADS changes while its threads run."""
    with _ONE:
        yield


def _opened(dispatcher: Any) -> Any:
    """Allow a dispatcher to compile for new types until `compiling` ends, and return it."""
    if hasattr(dispatcher, "disable_compile"):
        dispatcher.disable_compile(False)
        _OPEN.append(dispatcher)
    return dispatcher


def is_modules_own(known: Any) -> bool:
    """Return whether a function is defined under its name in its module's file, as all processes see it."""
    return _named(known) and getattr(sys.modules[known.__module__], "__file__", None) is not None


def _named(known: Any) -> bool:
    original = getattr(sys.modules.get(known.__module__), known.__qualname__, None)
    return original is not None and getattr(original, "function", original) is getattr(known, "function", known)


def _with_cache(function: Callable[..., Any], kept: bool, decorator: Callable[..., Any]) -> Any:
    """Return the decorated function; its compiled code is kept in `_folder`, if there is one."""
    numba, folder = load_numba(), _folder(function) if kept else None
    if folder is None:
        return decorator(numba, False)(function)
    with _ONE:
        previous_folder = numba.config.CACHE_DIR
        try:
            numba.config.CACHE_DIR = str(folder)
            return decorator(numba, True)(function)
        except OSError:  # a full disk
            return decorator(numba, False)(function)
        finally:
            numba.config.CACHE_DIR = previous_folder


def _folder(function: Callable[..., Any]) -> Path | None:
    """Return the folder of a function's compiled code: beside a bound module, or named after its sources."""
    base = kernels_folder() if is_modules_own(function) else None
    if base is None:
        return None
    file = Path(str(sys.modules[function.__module__].__file__))
    with suppress(OSError):  # a full disk
        return file.parent if file.is_relative_to(base) else sources_folder(base, sources_digest(str(file)))
    return None


def _mark(function: Callable[..., Any], types: Any) -> Path | None:
    """Return the path of the marker file for code compiled for these types."""
    config, folder = load_numba().config, _folder(function)
    identity = (function.__qualname__, types, load_numba().__version__, config.CPU_NAME, config.CPU_FEATURES)
    return None if folder is None else folder / f"{sha256([repr(identity)])[:16]}.known"


@contextmanager
def compiling(mark: Path | None = None, name: str = "kernels") -> Iterator[None]:
    """Let one thread of one process compile; others wait and load the result."""
    with _ONE, relaxed_gc(), _announced(name), raise_swallowed():  # as LLVM's callbacks do
        folder, until = kernels_folder(), time.monotonic() + _PATIENCE
        free = folder is None or fcntl is None or (mark is not None and mark.exists())
        with nullcontext() if free else (folder / "lock").open("w") as file:  # type: ignore[operator]
            while file is not None and time.monotonic() < until:  # a stopped process must not block others without end
                try:
                    fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    break
                except BlockingIOError:
                    time.sleep(_LOOK)
                except OSError:  # no locks on this disk
                    break
            try:
                yield
                if mark is not None:
                    with suppress(OSError):
                        mark.touch()
            finally:
                while _OPEN:
                    entry = _OPEN.pop()
                    entry.disable_compile(bool(entry.signatures))


@contextmanager
def _announced(name: str) -> Iterator[None]:
    """Announce within the block that kernels are compiled or awaited, once this takes long."""
    show_part(f"compiling {name}")  # beside a bar of tasks
    timer = Timer(_SILENT, _announce, [name])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        show_part("")


def _announce(name: str) -> None:
    """Write one line if a person is watching: on a terminal or in a notebook, not in worker processes."""
    if (sys.stderr.isatty() or "ipykernel" in sys.modules) and parent_process() is None and not _ANNOUNCED:
        _ANNOUNCED.append(name)
        logging.getLogger("flockana").warning(COMPILES.format(name))


@cache
def kernels_folder() -> Path | None:
    """Return the private folder of compiled code; None, with one warning, without one."""
    cache_setting = load_numba().config.CACHE_DIR
    candidate_folders: list[Callable[[], Path]] = [
        lambda: Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "flockana" / "kernels",
        lambda: Path(tempfile.gettempdir()) / f"flockana-kernels-{os.getuid()}",
    ]
    if cache_setting:
        candidate_folders = [lambda: Path(cache_setting) / "flockana"]
    # of two installations numba would give functions of one name the constants of each other
    installation = repr((__file__, load_numba().__version__, sys.version))
    for candidate_folder in candidate_folders:
        with suppress(OSError, RuntimeError, AttributeError):  # no home folder, or no user ids
            return sources_folder(_private(candidate_folder()), sha256([installation])[:16])
    logging.getLogger("flockana").warning(
        "no folder can be written to for compiled kernels: each process compiles its own; set NUMBA_CACHE_DIR to one"
    )
    return None


def _private(folder: Path) -> Path:
    """Return the folder if only this user can write to it; raise OSError otherwise."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    status = folder.lstat()
    if hasattr(os, "getuid") and (folder.is_symlink() or status.st_uid != os.getuid() or status.st_mode & 0o077):
        raise PermissionError(f"{folder} is not this user's alone")
    with tempfile.TemporaryFile(dir=folder):
        return folder


@cache
def sources_folder(base: Path, digest: str) -> Path:
    """Return the folder of compiled code of some sources; remove long unused folders."""
    folder, current_time = base / digest, time.time()
    if not folder.is_dir():
        folder.mkdir(mode=0o700, exist_ok=True)
        for sibling_folder in base.iterdir():
            with suppress(OSError):
                if sibling_folder.is_dir() and current_time - sibling_folder.stat().st_mtime > _UNUSED:
                    shutil.rmtree(sibling_folder, ignore_errors=True)
    os.utime(folder, (current_time, current_time))
    return folder


@cache
def sources_digest(file: str) -> str:
    """Return a digest of a file and of all files of the package that it imports, directly or not."""
    seen_files, files = set[Path](), {Path(file)}
    while files:
        seen_files |= files
        files = {imported_file for path in files for imported_file in _imported(path)} - seen_files
    return sha256([_FORM, *(path.read_bytes() for path in sorted(seen_files - {Path(__file__)}))])[:16]


@cache
def _imported(file: Path) -> frozenset[Path]:
    """Return the files of the package that a file imports; none for this module."""
    root, text = Path(__file__).parent, "" if file == Path(__file__) else file.read_text("utf-8")
    names = re.findall(r"^\s*(?:from|import) flockana\.([\w.]+)(?: import (\([^)]*\)|.+))?", text, re.MULTILINE)
    paths = set()
    for module, things in names:
        paths.add(root.joinpath(*module.split(".")).with_suffix(".py"))
        for imported_name in re.findall(r"\w+", things):  # it may be a module itself
            paths.add(root.joinpath(*module.split("."), imported_name).with_suffix(".py"))
    return frozenset(path for path in paths if path.is_file())
