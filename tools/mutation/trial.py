"""Run tests on one mutant, in a copy of the project that shares its files with a clean one (hard links).

A child is forked from a process that has loaded what tests load, except flockana itself: to start costs nothing. What
numba compiles of a mutant stays in its copy; all else it finds compiled.
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

_LOADED = ("numpy", "numba", "sympy", "scipy.integrate", "scipy.optimize", "scipy.sparse.linalg", "scipy.spatial")
_LOADED += ("scipy.special", "networkx", "mpmath", "flint", "hypothesis", "pytest", "xarray", "h5netcdf")
_IGNORED = shutil.ignore_patterns(".git", ".venv*", ".hypothesis", "*.ipynb", "*.tmp*")
_WRITTEN = {"report", "site", "dist", "course"}  # at the top: by runs, not by hands
_SLACK, _COMPILING = 10.0, 60.0  # seconds that a test file may take beyond three times its own; if kernels are compiled


@dataclass(frozen=True)
class Result:
    """What tests said: ``killed``, ``timeout`` (killed, too), ``survived``, or ``spent``: survived in the budget."""

    outcome: str
    by: str = ""
    seconds: float = 0.0
    files: int = 0

    @property
    def killed(self) -> bool:
        """Whether a test noticed."""
        return self.outcome in ("killed", "timeout")


def preload() -> None:
    """Load what the tests load."""
    for name in _LOADED:
        with suppress(ImportError):
            importlib.import_module(name)


def clean_copy(project: Path, folder: Path) -> Path:
    """A copy of a project with what is compiled of it."""
    tree = folder / "clean"
    shutil.rmtree(tree, ignore_errors=True)

    def left_out(folder: str, names: list[str]) -> set[str]:
        return _IGNORED(folder, names) | (_WRITTEN if Path(folder) == project else set())

    shutil.copytree(project, tree, ignore=left_out)
    return tree


@contextmanager
def mutated(clean: Path, path: str, source: str | None) -> Any:
    """A tree that differs from the clean one in one file."""
    with tempfile.TemporaryDirectory(prefix="mutant-", dir=clean.parent, ignore_cleanup_errors=True) as folder:
        tree = Path(folder) / "tree"
        shutil.copytree(clean, tree, copy_function=os.link)
        if source is not None:
            (tree / path).unlink()
            (tree / path).write_text(source, "utf-8")
        yield tree


class _Watch:
    """Keeps the name of the first test that fails."""

    def __init__(self) -> None:
        self.failed = ""

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed and not self.failed:
            self.failed = report.nodeid

    def pytest_collectreport(self, report: Any) -> None:
        if report.failed and not self.failed:
            self.failed = report.nodeid or "collection"


def _tests(tree: Path, files: Sequence[str], tell: int, log: Path, interpreted: bool) -> None:
    """In the child: give pytest one file after the other until one fails; tell of each, with its processor time."""
    import pytest

    os.setsid()
    for stream in (1, 2):
        os.dup2(os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND), stream)
    os.chdir(tree)
    os.environ["PYTHONPATH"], sys.dont_write_bytecode = str(tree), True
    # the tree's flockana, not another; what an editable install leaves beside all other libraries is no package
    others = (one for one in sys.path if one and not (Path(one) / "flockana" / "__init__.py").is_file())
    sys.path[:] = [str(tree), *others]
    if interpreted:
        importlib.import_module("numba").config.DISABLE_JIT = True
        os.environ["NUMBA_DISABLE_JIT"] = "1"
    for file in files:
        before, watch = time.process_time(), _Watch()
        code = pytest.main(["-x", "-q", "--no-header", "-p", "no:cacheprovider", "--tb=short", file], plugins=[watch])
        spent = time.process_time() - before + resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        failed = watch.failed if code in (0, 1, 5) else watch.failed or f"pytest ended with {int(code)}"
        os.write(tell, (json.dumps([file, failed, round(spent, 2)]) + "\n").encode())
        if failed:
            break


def _spent(child: int) -> float:
    """Processor time of a child."""
    with suppress(OSError):
        fields = Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()
        return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    return 0.0


def attempt(
    tree: Path, files: Sequence[str], usual: dict[str, float], budget: float, compiles: bool, interpreted: bool = False
) -> Result:
    """Run test files in a tree, one after the other, until one fails.

    Parameters
    ----------
    tree : Path
        A project.
    files : sequence of str
        Test files, relative to it.
    usual : dict
        Processor time in seconds that each takes unchanged. One that takes three times as long, and more, has hung.
    budget : float
        Seconds of processor time after which no further file is begun; one that is not the first ends after twice it.
    compiles : bool
        Whether compiled functions may have changed.
    interpreted : bool
        Run kernels as Python.

    Returns
    -------
    Result
        With the test that failed.
    """
    read, write = os.pipe()
    os.set_blocking(read, False)
    child = os.fork()
    if not child:
        code = 1
        try:
            _tests(tree, files, write, tree.parent / "log", interpreted)
            code = 0
        finally:
            os._exit(code)
    os.close(write)
    text, began, done, start = "", time.monotonic(), 0, 0.0
    try:
        while True:
            ended = os.waitpid(child, os.WNOHANG)[0] == child
            with suppress(BlockingIOError):
                text += os.read(read, 1 << 16).decode()
            said = [json.loads(line) for line in text.splitlines() if line.endswith("]")]
            spent = max(_spent(child), sum(one[2] for one in said))  # of a child that has ended nothing is known
            if said and said[-1][1]:
                return Result("killed", said[-1][1], spent, len(said))
            if len(said) == len(files):
                return Result("survived", "", spent, len(said))
            if ended:
                return Result("killed", f"{files[len(said)]} ended its process", spent, len(said))
            if len(said) > done:
                done, start, began = len(said), spent, time.monotonic()
                if spent > budget:
                    return Result("spent", "", spent, done)
            if done and spent > 2.0 * budget:
                return Result("spent", "", spent, done)
            limit = 3.0 * usual.get(files[done], 20.0) + (_COMPILING if compiles else _SLACK)
            if spent - start > limit or time.monotonic() - began > 10.0 * limit:
                return Result("timeout", files[done], spent, done)
            time.sleep(0.02)
    finally:
        os.close(read)
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(child, signal.SIGKILL)
        with suppress(ChildProcessError, ProcessLookupError):
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
