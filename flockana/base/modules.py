"""Discovery of a package's modules by their names."""

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from types import ModuleType


def modules(package: str, *, ending: str = "") -> Iterator[ModuleType]:
    """Import every module of a package and its subpackages whose name has the ending, in order of names."""
    for info in pkgutil.walk_packages(import_module(package).__path__, f"{package}."):
        if info.name.endswith(ending):
            yield import_module(info.name)
