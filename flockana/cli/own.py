"""What a command is about: a scenario, a saved run, or a flock of the user's own as ``FILE.py:NAME``."""

from __future__ import annotations

import os
import runpy
import traceback
from pathlib import Path
from typing import Any

from flockana.base.errors import ArgumentError, FileError, FlockanaError, UnknownNameError

KIND = "FILE.py:NAME"


def is_own(name: str | None) -> bool:
    """Return whether a name is that of a Python file, or of something in one."""
    return name is not None and (name.endswith(".py") or ".py:" in name)


def read_case(name: str, seed: int = 0) -> Any:
    """Return the scenario, the saved run, or what a Python file defines (a flock with the start of its seed)."""
    from flockana.dynamics.trajectory import Trajectory
    from flockana.scenarios import Flock, scenario, scenarios

    if is_own(name):
        case = read_own(name)
        return case.scenario(seed) if isinstance(case, Flock) else case
    if name not in scenarios() and (name.endswith(".nc") or os.path.exists(name)):
        return Trajectory.load(name)
    return scenario(name, seed)


def read_flock(name: str, seed: int = 0) -> Any:
    """Return a scenario as `read_case` does; of a run one with its law, start and time span."""
    from flockana.dynamics.trajectory import Trajectory
    from flockana.scenarios import Flock

    case = read_case(name, seed)
    if not isinstance(case, Trajectory):
        return case
    return Flock(case.law, case.q[0], case.p[0], (float(case.t[0]), float(case.t[-1])), name=name).scenario()


def read_own(name: str) -> Any:
    """Return the flock, scenario or run that a Python file defines; without a name the only one in it."""
    from flockana.dynamics.trajectory import Trajectory
    from flockana.scenarios import Scenario
    from flockana.scenarios.flock import Flock

    file, _, wanted = name.partition(".py:")
    path = Path(file if file.endswith(".py") else f"{file}.py")
    if not path.is_file():
        raise FileError(f"{path} is no file: expected {KIND}, a Python file and the name of a flock in it")
    try:
        defined = runpy.run_path(str(path), run_name="__flockana__")
    except FlockanaError as error:
        raise ArgumentError(f"{path}: {error}") from error
    except Exception as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
        where = f", line {lines[-1]}" if lines else ""
        raise ArgumentError(f"{path}{where}: {type(error).__name__}: {error}") from error
    flocks = {key: value for key, value in defined.items() if isinstance(value, (Flock, Scenario, Trajectory))}
    if wanted and wanted in flocks:
        return flocks[wanted]
    if wanted:
        raise UnknownNameError(f"flock in {path}", wanted, tuple(flocks))
    if len(flocks) != 1:
        listed = ", ".join(flocks) or "none"
        raise ArgumentError(
            f"{path} holds {len(flocks)} flocks ({listed}): expected one, or {KIND}; fl.Flock makes one"
        )
    return next(iter(flocks.values()))
