"""Starts that are computed when they are first asked for: to list a scenario needs its size, not its agents."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar, cast

from flockana.base.checks import FloatArray

T = TypeVar("T")


@dataclass(frozen=True)
class _Later:
    """An array of a known shape, and how to compute it."""

    shape: tuple[int, int]
    compute: Callable[[], FloatArray]


def later(shape: tuple[int, int], compute: Callable[[], FloatArray]) -> FloatArray:
    """Positions or velocities for a `Scenario`, which has them computed when it is first asked for them."""
    return cast("FloatArray", _Later(shape, compute))  # an array to whoever asks the scenario


def drawn_later(
    shape: tuple[int, int], draw: Callable[[], tuple[FloatArray, FloatArray]]
) -> tuple[FloatArray, FloatArray]:
    """Positions and velocities for a `Scenario` that are drawn together, once."""
    drawn = cache(draw)
    return later(shape, lambda: drawn()[0]), later(shape, lambda: drawn()[1])


def is_later(start: Any) -> bool:
    """Whether positions or velocities were given by `later`.

    Examples
    --------
    >>> is_later(later((2, 1), lambda: None))
    True
    """
    return isinstance(start, _Later)


class _Field:
    """A field of a dataclass that is an array to those who read it, however it was given."""

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
    """Let fields of a dataclass be given by `later`.

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
