"""Parameters of a law by name: reading and replacing."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from operator import attrgetter
from typing import Any, Self

import numpy as np

from flockana.base.errors import ArgumentError, UnknownNameError, format_value
from flockana.base.value_checks import FloatArray
from flockana.recorded.law_contributions import SYMBOLS, contributions


@dataclass(frozen=True)
class FreeParameters:
    """Parameters of a law that a fit may change, by dotted path such as ``gains.c1_alpha``."""

    law: Any
    names: tuple[str, ...]
    paths: tuple[str, ...]  # dotted names from the law on

    @classmethod
    def of(cls, law: Any, names: Sequence[str] | None) -> Self:
        """Return the named parameters, by default the law's gains; raise on an unknown or fixed name."""
        if names is None:
            names = [part.name for part in contributions(law) if part.name in SYMBOLS]
            if not names:
                listing = ", ".join(_names(law)) or "it has none"
                raise ArgumentError(f"free = None: {law.title} has no gains; name parameters: {listing}")
        if not isinstance(names, list | tuple) or not names or len(set(map(str, names))) < len(names):
            value_text = format_value(names)
            raise ArgumentError(f"free = {value_text}: expected names of parameters, each once, such as ('c1_alpha',)")
        paths = tuple(_path(law, str(name)) for name in names)
        parameters = cls(law, tuple(map(str, names)), paths)
        for name, value in zip(parameters.names, parameters.values, strict=True):
            if not np.isfinite(value):
                raise ArgumentError(f"{name} = {value}: expected one number to start from")
        return parameters

    @property
    def values(self) -> FloatArray:
        """Values of the free parameters in the law, as an array."""
        value_list = []
        for name, path in zip(self.names, self.paths, strict=True):
            value = law_parameter(self.law, path)
            if isinstance(value, bool) or not isinstance(value, int | float | np.number):
                raise ArgumentError(f"{name} = {format_value(value)}: expected a parameter that is one number")
            value_list.append(float(value))
        return np.array(value_list)

    def with_values(self, values: Sequence[float] | FloatArray) -> Any:
        """Return the law with new values of the parameters."""
        law = self.law
        for path, value in zip(self.paths, values, strict=True):
            law = with_parameter(law, path, float(value))
        return law


def law_parameter(law: Any, name: str) -> Any:
    """Return the value of a law's parameter by its dotted name, such as ``"gains.c1_alpha"``."""
    return attrgetter(name)(law)


def with_parameter(law: Any, name: str, value: Any) -> Any:
    """Return the law with another value of a parameter."""
    head, _, rest = name.partition(".")
    try:
        return replace(law, **{head: with_parameter(getattr(law, head), rest, value) if rest else value})
    except (AttributeError, TypeError):
        raise ArgumentError(
            f"{name}: {law.title} has no such number; expected a dotted name, such as gains.c1_alpha"
        ) from None


def _path(law: Any, name: str) -> str:
    """Return the dotted name of a parameter; a gain may be given by its name alone."""
    path = f"gains.{name}" if not hasattr(law, name) and hasattr(getattr(law, "gains", None), name) else name
    item = law
    for piece_text in path.split("."):
        if not is_dataclass(item) or piece_text not in {field.name for field in fields(item)}:
            raise UnknownNameError("parameter", name, _names(law))
        item = getattr(item, piece_text)
    return path


def _names(law: Any) -> tuple[str, ...]:
    """Return the names of numbers among the parameters of a law and its parts."""
    names: list[str] = []
    for field in fields(law):
        value = getattr(law, field.name)
        if is_dataclass(value) and not isinstance(value, type):
            inner = [item.name for item in fields(value) if isinstance(getattr(value, item.name), float)]
            names += inner if field.name == "gains" else [f"{field.name}.{item}" for item in inner]
        elif isinstance(value, float):
            names.append(field.name)
    return tuple(names)
