"""Lazy starts, computed on first access: listing scenarios needs only their sizes."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar, cast

from flockana.base.checks import FloatArray

T = TypeVar("T")


@dataclass(frozen=True)
class _LazyArray:
    """Array of known shape with a function that computes it."""

    shape: tuple[int, int]
    compute: Callable[[], FloatArray]


def lazy_array(shape: tuple[int, int], compute: Callable[[], FloatArray]) -> FloatArray:
    """Return positions or velocities for a `Scenario` that are computed on first access."""
    return cast("FloatArray", _LazyArray(shape, compute))  # an array to whoever asks the scenario


def lazy_state(
    shape: tuple[int, int], draw: Callable[[], tuple[FloatArray, FloatArray]]
) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities for a `Scenario` that are drawn together on first access."""
    drawn = cache(draw)
    return lazy_array(shape, lambda: drawn()[0]), lazy_array(shape, lambda: drawn()[1])


def is_lazy(start: Any) -> bool:
    """Return whether positions or velocities are lazy."""
    return isinstance(start, _LazyArray)


class _LazyArrayField:
    """Dataclass field that reads as an array, computed on first access."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __get__(self, item: Any, owner: type) -> Any:
        if item is None:
            return self
        value = vars(item)[self.name]
        if isinstance(value, _LazyArray):
            value = vars(item)[self.name] = value.compute()
        return value

    def __set__(self, item: Any, value: Any) -> None:
        vars(item)[self.name] = value


def accepts_lazy(*names: str) -> Callable[[type[T]], type[T]]:
    """Decorate a dataclass so that fields may be given by `lazy_array`."""

    def prepared(cls: type[T]) -> type[T]:
        for name in names:
            setattr(cls, name, _LazyArrayField(name))
        return cls

    return prepared
