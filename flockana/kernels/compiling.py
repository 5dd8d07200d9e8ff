"""numba's `njit` and `register_jitable`, which load numba when something is first computed: to list needs no compiler.

A kernel and a scalar function tell numba their type by its own protocol (``_numba_type_``), so kernels call either by
name as they would call numba's. What is compiled is kept as `flockana.kernels.caching` says.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cached_property
from typing import Any


class _Known:
    """A function that numba learns of when it first meets it."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.__module__, self.__doc__ = function.__module__, function.__doc__
        self.__name__, self.__qualname__ = function.__name__, function.__qualname__

    def __reduce__(self) -> Any:
        """By name where it has one: then what closes over it is the same in every process."""
        named = getattr(sys.modules.get(self.__module__), self.__qualname__, None) is self
        return self.__qualname__ if named else (type(self), self._arguments())

    def _arguments(self) -> tuple[Any, ...]:
        return (self.function,)


class Kernel(_Known):
    """A function that is compiled for the types that it is called with; what else numba's has, it has as well.

    Parameters
    ----------
    function : callable
        What to compile.
    options : dict
        Those of `numba.njit`, and ``cache``.
    """

    def __init__(self, function: Callable[..., Any], options: dict[str, Any]) -> None:
        super().__init__(function)
        self.options = options

    @cached_property
    def dispatcher(self) -> Any:
        """What numba made of it, to be called from Python."""
        from flockana.kernels.caching import dispatcher

        return dispatcher(self.function, **self.options)

    @cached_property
    def inner(self) -> Any:
        """What numba made of it, to be called from other kernels."""
        from flockana.kernels.caching import dispatcher

        return dispatcher(self.function, inner=True, **self.options)

    @property
    def _numba_type_(self) -> Any:
        return self.inner._numba_type_

    def __call__(self, *arguments: Any) -> Any:
        """Compute it, compiled."""
        return self.dispatcher(*arguments)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.dispatcher, name)

    def _arguments(self) -> tuple[Any, ...]:
        return self.function, self.options


class Inlined(_Known):
    """A function that is compiled into the kernels that call it; called from Python it is what it was.

    Parameters
    ----------
    function : callable
        A function of scalars.
    """

    @cached_property
    def _numba_type_(self) -> Any:
        from flockana.kernels.caching import inlined_type

        return inlined_type(self.function)

    def __call__(self, *arguments: Any) -> Any:
        """Compute it, interpreted."""
        return self.function(*arguments)


def njit(*, cache: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Kernel]:
    """`numba.njit`, whose cache may be filled by several processes at once, and which compiles what is called.

    Parameters
    ----------
    cache : bool
        Keep what is compiled on disk.
    **options
        Those of `numba.njit`.

    Examples
    --------
    >>> @njit()
    ... def twice(x):
    ...     return 2 * x
    >>> twice(21)
    42
    """
    return lambda function: Kernel(function, {"cache": cache, **options})


def register_jitable(function: Callable[..., Any]) -> Inlined:
    """`numba.extending.register_jitable`, to which numba comes later.

    Parameters
    ----------
    function : callable
        A function of scalars, for compiled and interpreted use.

    Examples
    --------
    >>> @register_jitable
    ... def twice(x):
    ...     return 2 * x
    >>> twice(21), njit()(lambda x: twice(x) + 1)(21)
    (42, 43)
    """
    return Inlined(function)
