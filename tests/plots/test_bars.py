from math import inf

import pytest

from flockana import plots
from flockana.base.errors import ArgumentError
from flockana.stability.robustness import LoopMargins, RobustnessMargins
from tests.plots.artists import axes


def test_a_bar_is_as_long_as_its_number_and_has_its_interval():
    table = {"a": {"x (length)": 2.0, "y": (3.0, 0.5)}, "b": {"x (length)": 1.0, "y": (4.0, 0.25)}}
    panels = plots.bars(table, limits={"y": 3.5}, ax=[axes(), axes()])
    assert [[bar.get_width() for bar in panel.patches] for panel in panels] == [[2.0, 1.0], [3.0, 4.0]]
    assert [label.get_text() for label in panels[0].get_yticklabels()] == ["a", "b"]
    assert panels[1].containers[1].lines[2][0].get_segments()[0][:, 0].tolist() == [2.5, 3.5]
    assert [line.get_xdata() for line in panels[1].lines if line.get_linestyle() == "--"] == [[3.5, 3.5]]
    assert panels[0].get_xlabel() == "$x$ (length)"


def test_margins_of_loops_are_such_a_table_and_no_limit_is_a_sign():
    found = RobustnessMargins((LoopMargins(3, 1, (0.5, inf), 40.0, 0.7, 1.5),))
    panels = plots.bars(found.table, ax=[axes() for _ in range(5)])
    assert list(found.table) == ["agent 3, y"]
    assert [panel.patches[0].get_width() for panel in panels] == [0.5, 1.2, 40.0, 0.7, 1.5]
    assert [text.get_text() for panel in panels for text in panel.texts] == ["∞"]


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({}, "table is empty"),
        ({"a": {"x": 1.0}, "b": {"y": 1.0}}, "row 'b' has the columns"),
        ({"a": {"x": "much"}}, "a, x = 'much'"),
    ],
)
def test_bad_input(table, message):
    with pytest.raises(ArgumentError, match=message):
        plots.bars(table)
