"""Conversion of parameter objects to JSON data and back.

A class of flockana is written by its name alone, ``flockana:Algorithm1``, wherever in the package it lives. Files that
named a module are read the same way. A user's class is named with its module, which must be imported before the file
is read.
"""

import json
import sys
from collections import Counter
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from itertools import chain
from pkgutil import resolve_name
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, FileError, format_value
from flockana.base.integrity_seals import public_name
from flockana.base.module_discovery import modules, source_modules

_ROOMS = (
    "interactions",
    "environment",
    "laws",
    "solvers",
)  # whose objects files may hold, and kinds of sources likewise


@cache
def parameter_classes() -> dict[str, type]:
    """Return every parameter class that a file may name, by its name."""
    classes_by_name: dict[str, type] = {}
    for module in chain.from_iterable((*modules(f"flockana.{room}"), *source_modules(room)) for room in _ROOMS):
        classes = (x for x in vars(module).values() if isinstance(x, type))
        classes_by_name |= {x.__name__: x for x in classes if is_dataclass(x) and x.__module__ == module.__name__}
    return classes_by_name


def to_data(value: Any) -> Any:
    """Turn a parameter object into JSON data: dataclasses become a dict with their ``"type"``."""
    if is_dataclass(value) and not isinstance(value, type):
        kind, values = getattr(value, "spelling", None) or (type(value), _parameters(value))
        data = {name: to_data(item) for name, item in values.items()}
        known_class = parameter_classes().get(kind.__qualname__) if kind.__module__.startswith("flockana.") else kind
        if known_class is None or (isinstance(kind, type) and known_class is not kind):
            raise ArgumentError(f"cannot write {value!r}: expected laws and their parts; rec.save writes recordings")
        return {"type": public_name(kind), **data}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [to_data(v) for v in value]
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise ArgumentError(
        f"cannot write {value!r} to a file: expected parameters made of numbers; "
        "a user's function has no such form, so describe it by a class of its own (see CONTRIBUTING, 'targets')"
    )


def _parameters(value: Any) -> dict[str, Any]:
    """Return the arguments of a dataclass's constructor by their names in files."""
    names = getattr(value, "names_in_files", {})
    return {names.get(f.name, f.name): getattr(value, f.name) for f in fields(value) if f.init}


def from_data(data: Any) -> Any:
    """Rebuild an object from `to_data`; only classes of flockana, or of imported modules, are allowed."""
    if isinstance(data, list):
        return tuple(from_data(v) for v in data)
    if not isinstance(data, dict):
        return data
    name = str(data.get("type"))
    module, _, qualname = name.partition(":")
    ours = module.partition(".")[0] == "flockana"
    if not ours and module not in sys.modules:
        raise FileError(f"the file needs {name}, which is not part of flockana: import {module} first, then load again")
    try:
        cls = parameter_classes().get(qualname) if ours else resolve_name(name)
        if cls is None or not is_dataclass(cls):
            raise TypeError(f"{name} is no parameter class")
        names: dict[str, str] = {written: name for name, written in getattr(cls, "names_in_files", {}).items()}
        return cls(**{names.get(str(key), str(key)): from_data(v) for key, v in data.items() if key != "type"})
    except (AttributeError, TypeError, ValueError) as error:
        raise FileError(f"cannot rebuild {name} from the file: {error}") from error


def read_json(text: str) -> Any:
    """Return the data of a JSON text; raise ValueError on bad JSON, duplicate keys and too deep nesting."""
    try:
        return json.loads(text, object_pairs_hook=_unique_keys)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a JSON object; raise on duplicate keys."""
    data = dict(pairs)
    if len(data) < len(pairs):
        repeated_name, _ = Counter(key for key, _ in pairs).most_common(1)[0]
        raise ValueError(f"the key {format_value(repeated_name)} is given twice")
    return data


def to_data_mapping(stats: Mapping[str, Any]) -> dict[str, Any]:
    """Return plain data of a mapping with text keys."""
    return {key: to_data(value) for key, value in stats.items()}
