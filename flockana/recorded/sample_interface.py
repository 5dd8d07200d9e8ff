"""Interface of recordings for functions: samples, gaps and accuracy."""

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray
from flockana.recorded.accuracy import Accuracy

_Result = TypeVar("_Result")


class Samples(Protocol):
    """Samples of a recorded flock, the base of `Recording`."""

    @property
    def t(self) -> FloatArray: ...  # noqa: D102

    @property
    def q(self) -> FloatArray: ...  # noqa: D102

    @property
    def p(self) -> FloatArray | None: ...  # noqa: D102

    @property
    def u(self) -> FloatArray | None: ...  # noqa: D102

    @property
    def bound(self) -> Any: ...  # noqa: D102

    @property
    def sd(self) -> Any: ...  # noqa: D102

    @property
    def p_bound(self) -> Any: ...  # noqa: D102

    @property
    def p_sd(self) -> Any: ...  # noqa: D102

    @property
    def estimated(self) -> bool: ...  # noqa: D102

    @property
    def smoothed(self) -> bool: ...  # noqa: D102

    @property
    def ids(self) -> Any: ...  # noqa: D102

    @property
    def source(self) -> str: ...  # noqa: D102

    @property
    def n(self) -> int: ...  # noqa: D102

    @property
    def m(self) -> int: ...  # noqa: D102

    @property
    def interval(self) -> float: ...  # noqa: D102

    @property
    def present(self) -> npt.NDArray[np.bool_]: ...  # noqa: D102

    @property
    def gaps(self) -> Any: ...  # noqa: D102

    @property
    def accuracy(self) -> Accuracy: ...  # noqa: D102

    def cached(self, key: str, compute: Callable[[], _Result]) -> _Result:
        """Return a named result, computed once and cached."""
        ...
