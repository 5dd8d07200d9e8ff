from collections.abc import Mapping

import pytest

from flockana.base.errors import ArgumentError
from flockana.base.kinds import check_kinds


@check_kinds
def first(responses: "Mapping[str, float]") -> str:
    return next(iter(responses))


def test_an_argument_of_another_kind_is_refused_by_name():
    assert first({"x": 1.0}) == "x"
    with pytest.raises(ArgumentError, match="responses = None: expected a mapping, such as a dict of values by label"):
        first(None)
