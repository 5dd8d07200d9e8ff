"""Tests that bad input is refused with a message."""

import re
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest

from flockana.base.errors import ArgumentError


def refused(*cases: Any, make: Callable[..., Any] | None = None, exact: bool = False, kind: Any = ArgumentError) -> Any:
    """Return a test that each call is refused with its message: `(call, message)` or `(call, message, its kind)`.

    With `make`, which is called with each dictionary of options or with each value, cases hold these instead of calls.
    `exact` takes a message as it stands, else it is a regular expression.
    """

    @pytest.mark.parametrize("row", cases, ids=[row[1] for row in cases])
    def test(row: Any) -> None:
        case, message, error = (*row, kind)[:3]
        call = case if make is None else partial(make, **case) if isinstance(case, dict) else partial(make, case)
        with pytest.raises(error, match=re.escape(message) if exact else message) as caught:
            call()
        assert "\n" not in str(caught.value)

    return test
