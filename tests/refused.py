"""Tests that bad input is refused with a message."""

import re
from collections.abc import Callable
from typing import Any

import pytest

from flockana.base.errors import ArgumentError


def refused(*cases: tuple[Any, str], make: Callable[..., Any] | None = None, exact: bool = False) -> Any:
    """Return a test that each call, or `make` with each dictionary of options, is refused with its message.

    `exact` takes a message as it stands, else it is a regular expression.
    """

    @pytest.mark.parametrize(("case", "message"), cases, ids=[message for _, message in cases])
    def test(case: Any, message: str) -> None:
        with pytest.raises(ArgumentError, match=re.escape(message) if exact else message) as caught:
            case() if make is None else make(**case)
        assert "\n" not in str(caught.value)

    return test
