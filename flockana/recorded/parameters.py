"""Parameters of a law by name: reading them, and the same law with others."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import reduce
from typing import Any, Self

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError, UnknownNameError, format_value
from flockana.recorded.contributions import SYMBOLS, contributions


@dataclass(frozen=True)
class FreeParameters:
    """Parameters of a law that a fit may change, by dotted path such as ``gains.c1_alpha``."""

    law: Any
    names: tuple[str, ...]
    paths: tuple[tuple[str, ...], ...]

    @classmethod
    def of(cls, law: Any, names: Sequence[str] | None) -> Self:
        """Return the named parameters, by default the law's gains; raise on an unknown or fixed name."""
        if names is None:
            names = [part.name for part in contributions(law) if part.name in SYMBOLS]
            if not names:
                raise ArgumentError(f"free = None: {type(law).__name__} has no gains; name parameters: {_known(law)}")
        if not isinstance(names, list | tuple) or not names or len(set(map(str, names))) < len(names):
            got = format_value(names)
            raise ArgumentError(f"free = {got}: expected names of parameters, each once, such as ('c1_alpha',)")
        paths = tuple(_path(law, str(name)) for name in names)
        found = cls(law, tuple(map(str, names)), paths)
        for name, value in zip(found.names, found.values, strict=True):
            if not np.isfinite(value):
                raise ArgumentError(f"{name} = {value}: expected one number to start from")
        return found

    @property
    def values(self) -> FloatArray:
        """Values in the law."""
        found = []
        for name, path in zip(self.names, self.paths, strict=True):
            value = reduce(getattr, path, self.law)
            if isinstance(value, bool) or not isinstance(value, int | float | np.number):
                raise ArgumentError(f"{name} = {format_value(value)}: expected a parameter that is one number")
            found.append(float(value))
        return np.array(found)

    def with_values(self, values: Sequence[float] | FloatArray) -> Any:
        """Return the law with other values."""
        law = self.law
        for path, value in zip(self.paths, values, strict=True):
            law = _replaced(law, path, float(value))
        return law


def _replaced(item: Any, path: tuple[str, ...], value: float) -> Any:
    first, *rest = path
    return replace(item, **{first: _replaced(getattr(item, first), tuple(rest), value) if rest else value})


def _path(law: Any, name: str) -> tuple[str, ...]:
    path = tuple(name.split("."))
    if len(path) == 1 and not hasattr(law, name) and hasattr(getattr(law, "gains", None), name):
        path = ("gains", name)
    item = law
    for part in path:
        if not is_dataclass(item) or part not in {field.name for field in fields(item)}:
            raise UnknownNameError("parameter", name, _names(law))
        item = getattr(item, part)
    return path


def _names(law: Any) -> tuple[str, ...]:
    """Numbers among the parameters of a law, and those of its parts."""
    found: list[str] = []
    for field in fields(law):
        value = getattr(law, field.name)
        if is_dataclass(value) and not isinstance(value, type):
            inner = [each.name for each in fields(value) if isinstance(getattr(value, each.name), float)]
            found += inner if field.name == "gains" else [f"{field.name}.{each}" for each in inner]
        elif isinstance(value, float):
            found.append(field.name)
    return tuple(found)


def _known(law: Any) -> str:
    return ", ".join(_names(law)) or "it has none"
