"""Arguments of another kind are refused by name, items of a sequence by their number."""

from collections.abc import Mapping, Sequence

import numpy as np
import pytest

import flockana as fl
from flockana import plots, stability
from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from tests.refused import refused

WALL = fl.Wall((0.0, 0.0), (1.0, 0.0))


test_another_kind_of_object_is_named = refused(
    (lambda: plots.obstacles(None), r"items = None: expected a sequence"),
    (lambda: plots.obstacles([WALL, "wall"]), r"items\[1\] = 'wall': expected an obstacle, such as Sphere"),
    (lambda: plots.side_by_side([1]), r"outcomes\[0\] = 1: expected one of what scenarios.one_start.compare"),
    (lambda: plots.velocity_diameters([None]), r"outcomes\[0\] = None: expected one of what"),
    (lambda: plots.save("figure", "it.pdf"), r"drawing = 'figure': expected a figure or Axes of matplotlib"),
    (lambda: stability.norms_against_size([1], [3]), r"expected Algorithm1 or Algorithm2, pairs"),
)


@check_kinds
def first(responses: "Mapping[str, float]") -> str:
    return next(iter(responses))


def test_an_argument_of_another_kind_is_refused_by_name():
    assert first({"x": 1.0}) == "x"
    with pytest.raises(ArgumentError, match="responses = None: expected a mapping, such as a dict of values by label"):
        first(None)


@check_kinds
def length(amplitudes: "Sequence[float]") -> int:
    return len(amplitudes)


def test_an_array_is_a_sequence_and_a_set_is_none():
    assert length(np.geomspace(1e-3, 0.3, 7)) == length([1.0] * 7) == 7
    with pytest.raises(ArgumentError, match=r"amplitudes = \{1.0\}: expected a sequence"):
        length({1.0})


def test_annotations_that_are_no_text_are_refused_where_a_function_is_made():
    def drawn(run: int) -> None: ...

    drawn.__annotations__["run"] = int
    with pytest.raises(TypeError, match="expected annotations as text"):
        check_kinds(drawn)
