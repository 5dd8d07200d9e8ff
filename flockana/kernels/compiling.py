"""numba's `njit` with a cache on disk that any number of processes may fill at once.

numba numbers the files of what it compiled, and enters the numbers in an index. Two processes that compile at once may
take the same number for two functions: then the index of the one names the code of the other, and what is loaded later
is another function. Here a file is named for what is in it, and is written before the index.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile


class _NamedByContent(IndexDataCacheFile):
    """An index, and files whose names no two functions, signatures, processors or versions of a source share."""

    def save(self, key: Any, data: Any) -> None:
        digest = hashlib.sha256(repr((key, self._source_stamp)).encode()).hexdigest()[:16]
        name = f"{self._index_name.removesuffix('.nbi')}.{digest}.nbc"
        self._save_data(name, data)
        self._save_index({**self._load_index(), key: name})  # of two at once one is lost, and compiled again


class _Cache(FunctionCache):
    """numba's cache of a function, with such files."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        own: IndexDataCacheFile = self._cache_file  # type: ignore[has-type]
        base = own._index_name.removesuffix(".nbi")
        self._cache_file = _NamedByContent(own._cache_path, base, own._source_stamp)


def njit(*, cache: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """`numba.njit`, whose cache may be filled by several processes at once.

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

    def compiled(function: Callable[..., Any]) -> Any:
        made = numba.njit(**options)(function)
        if cache:
            made._cache = _Cache(function)
        return made

    return compiled
