"""Subject of a command: a scenario, a saved run, or a user's flock or claim as ``FILE.py:NAME``."""

from __future__ import annotations

import os
import runpy
import sys
import traceback
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from flockana.base.errors import ArgumentError, FileError, FlockanaError, UnknownNameError, format_value

KIND = "FILE.py:NAME"


def is_own(name: str | None) -> bool:
    """Return whether a name denotes a Python file or an object in one."""
    return name is not None and (name.endswith(".py") or ".py:" in name)


def read_case(name: str, seed: int = 0) -> Any:
    """Return the scenario, the saved run, or the object of a Python file (a flock with the start of its seed)."""
    from flockana.dynamics.trajectory import Trajectory
    from flockana.scenarios import Flock, scenario, scenarios

    if is_own(name):
        case = read_own(name)
        return case.scenario(seed) if isinstance(case, Flock) else case
    if name not in scenarios() and (name.endswith(".nc") or os.path.exists(name)):
        return Trajectory.load(name)
    return scenario(name, seed)


def read_flock(name: str, seed: int = 0) -> Any:
    """Return a case as `read_case` does; a run becomes a case with its law, start and time span."""
    from flockana.dynamics.trajectory import Trajectory
    from flockana.scenarios import Flock

    case = read_case(name, seed)
    if not isinstance(case, Trajectory):
        return case
    return Flock(case.law, case.q[0], case.p[0], (float(case.t[0]), float(case.t[-1])), name=name).scenario()


def read_own(name: str) -> Any:
    """Return the flock, scenario or run of a Python file; without a name the only one."""
    from flockana.dynamics.trajectory import Trajectory
    from flockana.scenarios import Scenario
    from flockana.scenarios.flock import Flock

    return _one_of(
        name, "flock", (Flock, Scenario, Trajectory), "fl.Flock(law, q0) makes one; a claim is checked --on it"
    )


def read_theorem(name: str) -> Any:
    """Return the name of a theorem, or the user's claim from a Python file."""
    from flockana.theorems import Theorem

    return _one_of(name, "claim", (Theorem,), "fl.claim(name, margin) makes one") if is_own(name) else name


def read_law(name: str) -> Any:
    """Return the law of a Python file, or of its flock."""
    from flockana.laws import DiscreteLaw, Law, VelocityLaw
    from flockana.scenarios import Flock, Scenario

    item = _one_of(name, "law", (Law, DiscreteLaw, VelocityLaw, Flock, Scenario), "fl.compose(...) makes one")
    return item.law if isinstance(item, (Flock, Scenario)) else item


def _one_of(name: str, kind: str, classes: tuple[type, ...], remedy: str) -> Any:
    """Return a named object of a file, or the only object of given classes; raise otherwise."""
    file, _, wanted_name = name.partition(".py:")
    path = _path_of(file)
    defined_names = _names_in(path)
    items = {key: value for key, value in defined_names.items() if isinstance(value, classes)}
    if wanted_name in items:
        return items[wanted_name]
    if wanted_name in defined_names:
        raise ArgumentError(f"{name} is {format_value(defined_names[wanted_name])}: expected a {kind}; {remedy}")
    if wanted_name:
        raise UnknownNameError(f"{kind} in {path}", wanted_name, tuple(items))
    if len(items) != 1:
        listing = ", ".join(items) or "none"
        raise ArgumentError(f"{path} holds {len(items)} {kind}s ({listing}): expected one, or {KIND}; {remedy}")
    return next(iter(items.values()))


def _path_of(file: str) -> Path:
    path = Path(file if file.endswith(".py") else f"{file}.py")
    if not path.is_file():
        raise FileError(f"{path} is no file: expected {KIND}, a Python file and the name of a flock or claim in it")
    return path


def _names_in(path: Path) -> dict[str, Any]:
    """Return the names of a Python file, imported as a module so that worker processes find its functions."""
    full = path.resolve()
    if str(full.parent) not in sys.path:
        sys.path.append(str(full.parent))
    try:
        spec = find_spec(path.stem) if path.stem.isidentifier() else None
        if spec is not None and spec.origin == str(full):
            return vars(import_module(path.stem))
        return runpy.run_path(str(full), run_name="__flockana__")  # its name is another module's
    except FlockanaError as error:
        raise ArgumentError(f"{path}: {error}") from error
    except Exception as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(full)]
        place_text = f", line {lines[-1]}" if lines else ""
        raise ArgumentError(f"{path}{place_text}: {type(error).__name__}: {error}") from error
