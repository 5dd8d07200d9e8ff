"""What the numbers were measured on, and one core to measure them on."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def pin() -> int | None:
    """Stay on the first core that this process may use; None where the system cannot say so."""
    if not hasattr(os, "sched_setaffinity"):
        return None
    core = min(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    return core


def cores() -> int:
    """Cores that this process may use, before it is pinned to one."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def all_cores() -> Iterator[None]:
    """For a while every core that the system allows, which children inherit; then those of before."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, range(os.cpu_count() or 1))
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def facts(available: int, core: int | None) -> dict[str, str]:
    """Processor, cores, interpreter, libraries and compiler, each in a few words.

    Parameters
    ----------
    available : int
        Cores that there were before pinning.
    core : int or None
        The one that was taken.
    """
    pinned = "not pinned" if core is None else f"pinned to number {core}"
    return {
        "processor": f"{_processor()}, {_instructions()}",
        "cores": f"{available} available, {pinned}",
        "system": f"{platform.system()} {platform.release().split('-')[0]}, {platform.machine()}",
        "Python": platform.python_version(),
        **{name: _version(name) for name in ("flockana", "numpy", "scipy", "numba")},
        "BLAS": _blas(),
        "C compiler": _compiler(),
    }


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or "unknown"


def _instructions() -> str:
    info = Path("/proc/cpuinfo")
    flags = set(info.read_text().split()) if info.exists() else set()
    return next((name for flag, name in (("avx512f", "AVX-512"), ("avx2", "AVX2")) if flag in flags), "no AVX2 known")


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "missing"


def _blas() -> str:
    import numpy as np

    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    return f"{blas.get('name', 'unknown')} {blas.get('version', '')}".strip()


def _compiler() -> str:
    path = shutil.which("cc")
    if path is None:
        return "none"
    said = subprocess.run([path, "--version"], capture_output=True, text=True, check=False).stdout
    return said.splitlines()[0] if said else path


def notice(text: str) -> None:
    """One line to the terminal, at once."""
    sys.stderr.write(f"{text}\n")
    sys.stderr.flush()
