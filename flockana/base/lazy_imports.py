"""Lazy imports of a package's public names, listed in its stub file."""

import ast
from collections.abc import Callable
from importlib import import_module
from importlib.util import resolve_name
from pathlib import Path
from typing import Any

import lazy_loader


def attach_stub(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package whose ``.pyi`` file imports the public names.

    As lazy_loader's function of this name, and names from outside the package as well, under other names if so said.
    """
    inside_names: dict[str, list[str]] = {}
    outside_names: dict[str, tuple[str, str]] = {}  # by public name, a module and the name in it
    for node in ast.parse(Path(file).with_suffix(".pyi").read_text("utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            inside_names.setdefault(node.module or "", []).extend(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = resolve_name("." * node.level + (node.module or ""), package)
            outside_names |= {alias.asname or alias.name: (module, alias.name) for alias in node.names}
    get_inside, _, names = lazy_loader.attach(package, inside_names.pop("", ()), inside_names)
    all_names = sorted((*names, *outside_names))

    def get(name: str) -> Any:
        if name not in outside_names:
            return get_inside(name)
        module, attribute = outside_names[name]
        owner = import_module(module)
        return getattr(owner, attribute) if hasattr(owner, attribute) else import_module(f"{module}.{attribute}")

    return get, lambda: [*all_names], all_names
