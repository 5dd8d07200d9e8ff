"""Cache of computed results, stored on the source object."""

from collections.abc import Callable
from functools import cached_property
from typing import Any, TypeVar

_Value = TypeVar("_Value")


class ResultCache:
    """Base class of objects that cache results computed from them."""

    def cached(self, name: str, compute: Callable[[], _Value]) -> _Value:
        """Return a named result of an object, computed at the first call and cached on the object.

        Parameters
        ----------
        compute : callable
            Gives it.

        Examples
        --------
        >>> kept = ResultCache()
        >>> kept.cached("answer", lambda: 42), kept.cached("answer", lambda: 0)
        (42, 42)
        """
        if name not in self._memory:
            self._memory[name] = compute()
        return self._memory[name]

    @cached_property
    def _memory(self) -> dict[str, Any]:
        return {}
