"""Catalogue of theorems: all theorems of this package and the sources, by id."""

import re
from collections.abc import Iterator
from functools import cache
from types import ModuleType

from flockana.base.errors import ArgumentError, UnknownNameError, format_value
from flockana.base.module_discovery import modules, source_modules
from flockana.theorems.theorem import Theorem


@cache
def catalogue() -> dict[str, Theorem]:
    """Return all theorems by id, from every module of this package and of the sources' theorems."""
    by_id = {item.id: item for module in theorem_modules() for item in theorems_in(module).values()}
    # E2 before E10, and the errata after the theorems
    numbers = {name: [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)] for name in by_id}
    return {name: by_id[name] for name in sorted(by_id, key=lambda name: (name[:1].isupper(), numbers[name]))}


def theorem_modules() -> Iterator[ModuleType]:
    """Import all modules that may define theorems."""
    yield from modules("flockana.theorems")
    yield from source_modules("theorems")


def theorems_in(module: ModuleType) -> dict[str, Theorem]:
    """Return the theorems defined in a module, by name."""
    return {name: item for name, item in vars(module).items() if isinstance(item, Theorem)}


def theorems() -> tuple[str, ...]:
    """Return the ids of every theorem, correction and erratum.

    Examples
    --------
    >>> "os-1" in theorems() and "E1" in theorems()
    True
    """
    return tuple(catalogue())


def theorem(name: str | Theorem) -> Theorem:
    """Return a theorem by its id or printed name.

    Parameters
    ----------
    name : str
        One of `theorems`, or the name that its source prints, such as "Theorem 3"; a theorem is returned as it is.

    Raises
    ------
    UnknownNameError
        If there is none; the closest name is suggested.
    ArgumentError
        If several sources print a theorem of that name, or on what is neither a name nor a theorem.

    Examples
    --------
    >>> theorem("os-3").kind, theorem("Theorem 3").id
    ('trajectory', 'os-3')
    """
    if isinstance(name, Theorem):
        return name
    if not isinstance(name, str):
        text = (
            "expected a name, such as 'os-3', or a claim of your own, fl.claim(name, margin) with a function of a run"
        )
        raise ArgumentError(f"theorem = {format_value(name)}: {text}")
    return catalogue().get(name) or _printed_as(name)


def _printed_as(name: str) -> Theorem:
    """Return the theorem with a printed name such as "Theorem 3"."""
    pattern = re.compile(rf"\b{re.escape(name.strip())}$", re.IGNORECASE)
    matches = [x for x in catalogue().values() if x.id[0].islower() and pattern.search(re.split(r";| \(", x.source)[0])]
    if len(matches) == 1:
        return matches[0]
    if matches:
        listing = "; ".join(f"{x.id} ({x.source})" for x in matches)
        raise ArgumentError(f"several theorems are printed as {name!r}: expected one of {listing}")
    raise UnknownNameError("theorem", name, theorems())
