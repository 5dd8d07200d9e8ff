"""Files that references such as ``theorem:os-1`` lead to, in a checkout."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

import flockana
from flockana.base.errors import ArgumentError, FileError, FlockanaError, UnknownNameError
from flockana.base.module_discovery import source_modules
from flockana.report.coverage import Reference, Source
from flockana.report.coverage.report_anchors import is_erratum
from flockana.scenarios import scenario, scenarios
from flockana.theorems import theorem, theorems
from flockana.theorems.catalogue import theorem_modules, theorems_in

_CHECKOUT = Path(__file__).resolve().parents[1]  # the folder that holds the package


def locate(reference: Reference) -> str:
    """Return the file in the package that a reference leads to; nothing is run to find it."""
    return _KINDS[reference.kind](reference.name)


def faults(sources: Iterable[Source]) -> tuple[str, ...]:
    """Return a line for each reference that leads nowhere, with its source and place."""
    found = []
    for source in sources:
        for row in source.rows:
            for reference in row.held_by:
                try:
                    locate(reference)
                except FlockanaError as error:
                    found.append(f"{source.key}, {row.place}: {error}")
    return tuple(found)


def _function(name: str) -> str:
    return _relative(_file(*_resolve("function", name)))


def _plot(name: str) -> str:
    path = _relative(_file(*_resolve("plot", name)))
    if not path.startswith("flockana/plots/") and not re.match(r"flockana/sources/\w+/plots\b", path):
        raise ArgumentError(
            f"plot {name!r} is defined in {path}: expected one of flockana.plots; else call it function"
        )
    return path


def _resolve(kind: str, name: str) -> tuple[Any, Any]:
    """Return the object that a dotted name leads to, and its owner."""
    first, *parts = name.split(".")
    if first != flockana.__name__ or not parts:
        raise UnknownNameError(kind, name, [f"flockana.{known}" for known in flockana.__all__])
    holder: Any = flockana
    found: Any = flockana
    for k, part in enumerate(parts):
        holder = found
        if hasattr(holder, part):
            found = getattr(holder, part)
        elif part in getattr(holder, "__dataclass_fields__", {}):
            found = holder  # a field without a default is no attribute of its class
        else:
            path = ".".join([first, *parts[:k]])
            try:
                found = import_module(f"{path}.{part}")
            except ModuleNotFoundError:
                raise UnknownNameError(kind, name, [f"{path}.{other}" for other in _names(holder)]) from None
    return found, holder


def _names(holder: Any) -> list[str]:
    """Return the public names of a module or class, with a package's modules not yet imported."""
    within = {module.name for module in iter_modules(getattr(holder, "__path__", []))}
    return sorted(name for name in {*dir(holder), *within} if not name.startswith("_"))


def _file(found: Any, holder: Any) -> str:
    """Return the source file of a function, class, property or kernel, or of the owner of anything else."""
    if isinstance(found, property):
        found = found.fget
    found = inspect.unwrap(getattr(found, "py_func", found))
    try:
        return inspect.getsourcefile(found) or ""
    except TypeError:
        return inspect.getsourcefile(holder) or ""


@cache
def _theorem_files() -> dict[str, str]:
    return {item.id: str(m.__file__) for m in theorem_modules() for item in theorems_in(m).values()}


@cache
def _scenario_files() -> dict[str, str]:
    return {name: str(m.__file__) for m in source_modules("scenarios") for name in getattr(m, "SCENARIOS", ())}


def _scenario(name: str) -> str:
    if name not in scenarios():
        raise UnknownNameError("scenario", name, scenarios())
    return _relative(_scenario_files()[name])


def _report(name: str) -> str:
    """Return the file of a source report, named ``scenario/report``."""
    of, _, report = name.partition("/")
    path = _scenario(of)
    known = [f"{of}/{one.name}" for one in scenario(of).reports]
    if name not in known:
        raise UnknownNameError("report", f"{of}/{report}", known)
    return path


def _theorem(name: str) -> str:
    return _of_catalogue("theorem", name, [known for known in theorems() if not is_erratum(known)])


def _erratum(name: str) -> str:
    return _of_catalogue("erratum", name, [known for known in theorems() if is_erratum(known)])


def _of_catalogue(kind: str, name: str, known: list[str]) -> str:
    if name not in known:
        raise UnknownNameError(kind, name, known)
    return _relative(_theorem_files()[name])


def _claim(name: str) -> str:
    """Return the file of a claim ``id/claim`` of a theorem or erratum; raise if there is none."""
    of, _, _ = name.partition("/")
    path = _of_catalogue("theorem or erratum", of, list(theorems()))
    item = theorem(of)
    declared = (*item.claims, *(key.partition(":")[2] for key in item.expected if ":" in key))
    if name not in (known := [f"{of}/{claim}" for claim in dict.fromkeys(declared)]):
        raise UnknownNameError("claim", name, known)
    return path


def _proof(name: str) -> str:
    known = {path.stem: path for path in _python_files("proofs") if "\nPROOF = " in path.read_text(encoding="utf-8")}
    if name not in known:
        raise UnknownNameError("proof", name, known)
    return _relative(str(known[name]))


def _notebook(number: str) -> str:
    known = {path.stem.partition("_")[0]: path for path in _python_files("notebooks")}
    if number not in known:
        raise UnknownNameError("notebook", number, known)
    return _relative(str(known[number]))


def _python_files(folder: str) -> list[Path]:
    """Return the Python files of a folder of the checkout, except templates."""
    found = sorted(path for path in (_CHECKOUT / folder).glob("*.py") if not path.name.startswith("_"))
    if not found:
        raise FileError(f"there is no folder {folder} in {_CHECKOUT}: expected a checkout, which has one")
    return found


def _relative(file: str) -> str:
    return Path(file).resolve().relative_to(_CHECKOUT).as_posix()


_KINDS: dict[str, Callable[[str], str]] = {
    "function": _function,
    "plot": _plot,
    "scenario": _scenario,
    "report": _report,
    "theorem": _theorem,
    "claim": _claim,
    "erratum": _erratum,
    "proof": _proof,
    "notebook": _notebook,
}
