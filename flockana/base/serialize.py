"""Frozen parameter objects to plain data and back, so that a saved run carries its law and can be re-verified."""

from __future__ import annotations

import importlib
import sys
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, FileError


def to_data(value: Any) -> Any:
    """Turn a parameter object into JSON data: dataclasses become a dict with their ``"type"``.

    Parameters
    ----------
    value : object
        A flockana parameter dataclass, or numbers, strings, arrays and sequences of them.

    Raises
    ------
    ArgumentError
        If something in it cannot be written down, such as a user's function.

    Examples
    --------
    >>> to_data((1.0, np.array([2.0, 3.0])))
    [1.0, [2.0, 3.0]]
    """
    if is_dataclass(value) and not isinstance(value, type):
        data = {f.name: to_data(getattr(value, f.name)) for f in fields(value) if f.init}
        return {"type": f"{type(value).__module__}:{type(value).__qualname__}", **data}
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


def from_data(data: Any) -> Any:
    """Rebuild what `to_data` wrote; only dataclasses of flockana, or of modules already imported, are made.

    Parameters
    ----------
    data : object
        JSON data.

    Raises
    ------
    FileError
        If a type is unknown here, or its parameters do not fit.

    Examples
    --------
    >>> from_data([1.0, "two"])
    (1.0, 'two')
    """
    if isinstance(data, list):
        return tuple(from_data(v) for v in data)
    if not isinstance(data, dict):
        return data
    name = str(data.get("type"))
    module, _, qualname = name.partition(":")
    if not module.startswith("flockana.") and module not in sys.modules:
        raise FileError(f"the file needs {name}, which is not part of flockana: import {module} first, then load again")
    try:
        cls: Any = importlib.import_module(module)
        for part in qualname.split("."):
            cls = getattr(cls, part)
        if not (isinstance(cls, type) and is_dataclass(cls)):
            raise TypeError(f"{name} is no parameter class")
        return cls(**{key: from_data(v) for key, v in data.items() if key != "type"})
    except (ImportError, AttributeError, TypeError, ValueError) as error:
        raise FileError(f"cannot rebuild {name} from the file: {error}") from error
