"""Numeric parameters of a law by path: listing, replacement, and replacement as Python.

A page changes numbers and nothing else: it names a path that the law has and gives a number, or a vector of as many.
What they may be the law's own classes say, which check them as they do when a program makes them.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from flockana.base.errors import UnknownNameError
from flockana.base.value_checks import ensure_finite_scalar, ensure_flag, ensure_vector

Value = bool | int | float | tuple[float, ...]
Tree = dict[str, Any]  # changed fields by name, or places in a tuple; a leaf is a value

_PLACES = ("centre", "point", "q", "start", "a", "b")  # vectors that are places, of obstacles and targets
_COMPONENTS = 3


@dataclass(frozen=True)
class Number:
    """Numeric parameter of a law: a number or a short vector."""

    path: str  # names of fields and numbers in tuples, such as ``"gains.c1_gamma"`` or ``"obstacles.0.centre"``
    value: Value  # as it is
    place: bool = False  # whether it is where an obstacle or a target is, so that a page may let it be dragged


def numbers(law: Any) -> tuple[Number, ...]:
    """Return every number and short vector among a law's parameters, nested ones included."""
    return tuple(_listed(law, ()))


def _listed(item: Any, path: tuple[str, ...]) -> Iterator[Number]:
    if is_dataclass(item):
        for name in (entry.name for entry in fields(item) if entry.init):
            yield from _listed(getattr(item, name), (*path, name))
    elif isinstance(item, bool | int | float | np.number):
        yield Number(".".join(path), item if isinstance(item, bool | int) else float(item))
    elif isinstance(item, tuple | np.ndarray):
        numeric = all(isinstance(x, int | float | np.number) and not isinstance(x, bool) for x in item)
        if numeric and 1 <= len(item) <= _COMPONENTS:
            is_place = path[-1] in _PLACES and ("target" in path or "obstacles" in path)
            yield Number(".".join(path), tuple(float(x) for x in item), is_place)
        for k, entry in enumerate(item):
            if is_dataclass(entry):
                yield from _listed(entry, (*path, str(k)))


def tree_of(law: Any, changes: Mapping[str, Any]) -> Tree:
    """Return changes of a law's parameters, given by dotted path, as a tree; raise on invalid values."""
    values = {number.path: number.value for number in numbers(law)} if changes else {}
    tree: Tree = {}
    for path, value in changes.items():
        if path not in values:
            raise UnknownNameError("parameter", path, values)
        *branch, leaf = path.split(".")
        at = tree
        for name in branch:
            at = at.setdefault(name, {})
        at[leaf] = _convert(path, values[path], value)
    return tree


def _convert(path: str, old: Value, given: Any) -> Value:
    if isinstance(old, tuple):
        return tuple(ensure_vector(path, given, len(old)).tolist())
    if isinstance(old, bool):
        return ensure_flag(path, given)
    number = ensure_finite_scalar(path, given)
    return int(number) if isinstance(old, int) and number.is_integer() else number


def changed(item: Any, tree: Tree) -> Any:
    """Return a law with changed parameters, validated by its class."""
    if not isinstance(tree, dict):
        return tree
    if isinstance(item, tuple):
        return tuple(changed(entry, tree[str(k)]) if str(k) in tree else entry for k, entry in enumerate(item))
    if not tree:
        return item
    return replace(item, **{name: changed(getattr(item, name), entry) for name, entry in tree.items()})


def expression(name: str, item: Any, tree: Tree) -> str:
    """Return a Python expression that builds a law with changed parameters from the law of a given name."""
    if not isinstance(tree, dict):
        return repr(tree)
    if not tree:
        return name
    if isinstance(item, tuple):
        parts = (expression(f"{name}[{k}]", entry, tree.get(str(k), {})) for k, entry in enumerate(item))
        return f"({', '.join(parts)},)"
    arguments = (f"{key}={expression(f'{name}.{key}', getattr(item, key), entry)}" for key, entry in tree.items())
    return f"replace({name}, {', '.join(arguments)})"
