import numpy as np
import pytest
from scipy.spatial.distance import pdist

from flockana import plots
from flockana.base.errors import ArgumentError
from flockana.scenarios.one_start import compare
from tests.plots.artists import axes


@pytest.fixture(scope="module")
def outcomes():
    return compare(["Dead zone", "Averaged headings"])


def test_all_are_drawn_on_one_equal_scale(outcomes):
    panels = plots.side_by_side(outcomes, ax=[axes(), axes()])
    scales = [(ax.get_xlim(), ax.get_ylim()) for ax in panels]
    assert scales[0] == scales[1]
    assert np.ptp(scales[0][0]) == pytest.approx(np.ptp(scales[0][1]))
    for outcome, ax in zip(outcomes, panels, strict=True):
        start, end = (np.asarray(points.get_offsets()) for points in ax.collections[-2:])
        assert np.array_equal(start, outcome.run.q[0])
        assert np.array_equal(end, outcome.run.q[-1])
        assert outcome.entry.theorem in ax.get_title(loc="left")
        assert outcome.verdict.status in ax.get_title(loc="left")


def test_lines_differ_by_dash_or_mark(outcomes):
    many = [*outcomes] * 6
    lines = plots.velocity_diameters(many, ax=axes()).get_lines()
    assert len(lines) == len(many)
    looks = {(line.get_marker(), str(line._dash_pattern)) for line in lines}
    assert len(looks) == len(many)
    np.testing.assert_allclose(lines[0].get_ydata()[0], 1.0)
    first, last = (pdist(outcomes[0].run.p[k]).max() for k in (0, -1))
    assert lines[0].get_ydata()[-1] == pytest.approx(last / first)


def test_a_figure_of_its_own_has_a_panel_for_each(outcomes):
    panels = plots.side_by_side([*outcomes] * 3)
    assert len(panels) == 6
    assert len(panels[0].get_figure().axes) == 6


def test_bad_numbers(outcomes):
    with pytest.raises(ArgumentError, match="1 axes for 2 laws"):
        plots.side_by_side(outcomes, ax=[axes()])
    for draw in (plots.side_by_side, plots.velocity_diameters):
        with pytest.raises(ArgumentError, match="outcomes is empty"):
            draw([])
