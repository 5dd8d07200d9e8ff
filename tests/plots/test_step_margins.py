import pytest

from flockana import plots
from flockana.base.errors import ArgumentError
from tests.plots.artists import axes


def test_bars_begin_at_one_and_end_at_the_ratio():
    ax = plots.step_margins({"stable": (0.2, 0.1), "unstable": (0.05, 0.1)}, ax=axes())
    stable, unstable = ax.patches
    assert (stable.get_x(), stable.get_width()) == (1.0, pytest.approx(1.0))
    assert unstable.get_x() + unstable.get_width() == pytest.approx(0.5)
    assert unstable.get_hatch()
    assert [label.get_text() for label in ax.get_yticklabels()] == ["stable", "unstable"]
    assert [text.get_text() for text in ax.texts] == ["2", "0.5"]
    assert [ax.xaxis.get_major_formatter()(tick) for tick in (0.05, 1.0, 200.0)] == ["0.05", "1", "200"]


@pytest.mark.parametrize(("steps", "message"), [({}, "steps is empty"), ({"a": (0.1, 0.0)}, "a: dt = 0")])
def test_bad_input(steps, message):
    with pytest.raises(ArgumentError, match=message):
        plots.step_margins(steps, ax=axes())
