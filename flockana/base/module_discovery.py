"""Discovery of a package's modules by their names, and of the parts of sources by their kinds."""

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

SOURCES = "flockana.sources"


def source_files(pattern: str) -> Iterator[Path]:
    """Yield the files that match a pattern in the subpackages of `flockana.sources`, sorted by name."""
    for folder in import_module(SOURCES).__path__:
        yield from sorted(Path(folder).glob(f"*/{pattern}"))


def modules(package: str) -> Iterator[ModuleType]:
    """Import every module of a package and its subpackages, in order of names."""
    for info in pkgutil.walk_packages(import_module(package).__path__, f"{package}."):
        yield import_module(info.name)


def source_modules(kind: str) -> Iterator[ModuleType]:
    """Import the modules of one kind, such as laws, from all subpackages of `flockana.sources`."""
    for module_info in pkgutil.iter_modules(import_module(SOURCES).__path__, f"{SOURCES}."):
        name = f"{module_info.name}.{kind}"
        spec = find_spec(name) if module_info.ispkg else None
        if spec is not None and spec.origin is not None:  # a module
            yield import_module(name)
        if spec is not None and spec.submodule_search_locations is not None:
            yield from modules(name)
