"""Lazy starts, computed on first access: listing scenarios needs only their sizes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar, cast

from flockana.base.checks import FloatArray

T = TypeVar("T")


@dataclass(frozen=True)
class _Later:
    """Array of known shape with a function that computes it."""

    shape: tuple[int, int]
    compute: Callable[[], FloatArray]


def later(shape: tuple[int, int], compute: Callable[[], FloatArray]) -> FloatArray:
    """Return positions or velocities for a `Scenario` that are computed on first access."""
    return cast("FloatArray", _Later(shape, compute))  # an array to whoever asks the scenario


def drawn_later(
    shape: tuple[int, int], draw: Callable[[], tuple[FloatArray, FloatArray]]
) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities for a `Scenario` that are drawn together on first access."""
    drawn = cache(draw)
    return later(shape, lambda: drawn()[0]), later(shape, lambda: drawn()[1])


def is_later(start: Any) -> bool:
    """Return whether positions or velocities are lazy.

    Examples
    --------
    >>> is_later(later((2, 1), lambda: None))
    True
    """
    return isinstance(start, _Later)


class _Field:
    """Dataclass field that reads as an array, computed on first access."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __get__(self, item: Any, owner: type) -> Any:
        if item is None:
            return self
        value = vars(item)[self.name]
        if isinstance(value, _Later):
            value = vars(item)[self.name] = value.compute()
        return value

    def __set__(self, item: Any, value: Any) -> None:
        vars(item)[self.name] = value


def given_later(*names: str) -> Callable[[type[T]], type[T]]:
    """Decorate a dataclass so that fields may be given by `later`.

    Examples
    --------
    >>> import numpy as np
    >>> @given_later("q")
    ... @dataclass(frozen=True)
    ... class Flock:
    ...     q: FloatArray
    >>> flock = Flock(later((2, 1), lambda: np.array([[0.0], [7.0]])))
    >>> flock.q.ravel().tolist(), flock.q is flock.q
    ([0.0, 7.0], True)
    """

    def prepared(cls: type[T]) -> type[T]:
        for name in names:
            setattr(cls, name, _Field(name))
        return cls

    return prepared
