"""Consistency of overridden methods with class attributes that describe them."""

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from types import FunctionType
from typing import Any

from flockana.base.errors import ArgumentError


def overrides_consistently(kind: type, name: str, others: Iterable[str]) -> bool:
    """Return whether each subclass that overrides one of the methods `others` overrides `name` too."""
    classes = list(kind.__mro__)
    defining_index = next(k for k, base in enumerate(classes) if name in vars(base))
    return not any(other in vars(base) for base in classes[:defining_index] for other in others)


def ensure_consistent(item: Any) -> None:
    """Raise if a law overrides a public method, but not the method that integrators call for it."""
    # ``derived_methods`` of a class of the library are public methods that follow from one which integrators call:
    # a user's class that changes only the former would be integrated without the change, as would an instance with a
    # method of its own.
    kind = type(item)
    derived_methods: Mapping[str, tuple[str, ...]] = getattr(kind, "derived_methods", {})
    for source, derived in derived_methods.items():
        defining_index = next((k for k, base in enumerate(kind.__mro__) if source in vars(base)), 0)
        for base in kind.__mro__[:defining_index]:
            for name in () if base.__module__.startswith("flockana.") else derived:
                if name in vars(base):
                    raise ArgumentError(
                        f"{base.__name__} defines {name}, but not {source}, from which it follows: the integrators ask "
                        f"for {source}, so {name} would be ignored; define {source} anew instead"
                    )
    for name in getattr(item, "__dict__", ()):
        if isinstance(getattr(kind, name, None), FunctionType):
            raise ArgumentError(
                f"this {kind.__name__} was given its own {name}, which compiled code would not call: expected the "
                "method of its class; derive a class that defines it anew"
            )
    for value in [getattr(item, field.name) for field in fields(item)] if is_dataclass(item) else ():
        for part in value if isinstance(value, tuple) else (value,):
            if hasattr(part, "derived_methods"):
                ensure_consistent(part)
