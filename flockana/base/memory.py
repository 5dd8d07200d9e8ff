"""Results that are computed once for an object and kept as long as it lives."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, TypeVar

_Value = TypeVar("_Value")


class ResultCache:
    """An object that keeps, beside its fields, what others computed from it."""

    def cached(self, name: str, compute: Callable[[], _Value]) -> _Value:
        """What was computed from this object before, or is now.

        Parameters
        ----------
        name : str
            What it is.
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
        return self._memory[name]  # type: ignore[no-any-return]

    @cached_property
    def _memory(self) -> dict[str, Any]:
        return {}
