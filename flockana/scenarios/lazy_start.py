"""Lazy starts, computed on first access: listing scenarios needs only their sizes."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, cast

from flockana.base.value_checks import FloatArray


@dataclass(frozen=True)
class LazyArray:
    """Array of known shape with a function that computes it."""

    shape: tuple[int, int]
    compute: Callable[[], FloatArray]


def lazy_array(shape: tuple[int, int], compute: Callable[[], FloatArray]) -> FloatArray:
    """Return positions or velocities for a `Scenario` that are computed on first access."""
    return cast("FloatArray", LazyArray(shape, compute))  # an array to whoever asks the scenario


def lazy_state(
    shape: tuple[int, int], draw: Callable[[], tuple[FloatArray, FloatArray]]
) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities for a `Scenario` that are drawn together on first access."""
    state = cache(draw)
    return lazy_array(shape, lambda: state()[0]), lazy_array(shape, lambda: state()[1])


class LazyField:
    """Field of a dataclass that reads as an array, computed on first access."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __get__(self, item: Any, owner: type) -> Any:
        if item is None:
            return self
        value = vars(item)[self.name]
        if isinstance(value, LazyArray):
            value = vars(item)[self.name] = value.compute()
        return value

    def __set__(self, item: Any, value: FloatArray) -> None:
        vars(item)[self.name] = value
