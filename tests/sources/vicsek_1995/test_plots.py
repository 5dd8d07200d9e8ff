import numpy as np
import pytest

from flockana import Algorithm1, HeadingAveraging, plots, scenario, simulate
from flockana.base.errors import ArgumentError
from flockana.report.figures import pictures
from tests.plots.artists import axes

LAW = HeadingAveraging(range=1.0, speed=0.1, dt=1.0)


def test_headings_as_they_are_averaged():
    run = simulate(LAW, [[0.0, 0.0], [0.5, 0.0]], LAW.velocities([1.0, 6.0]), (0.0, 2.0))
    one, other = plots.headings(run, ax=axes()).get_lines()
    np.testing.assert_allclose(one.get_ydata(), [1.0, 3.5, 3.5])
    np.testing.assert_allclose(other.get_ydata(), [6.0, 3.5, 3.5])


def test_links_are_drawn_on_the_circle_too_and_without_arrowheads():
    run = simulate(LAW, [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]], LAW.velocities([1.0, 1.0, 1.0]), (0.0, 1.0))
    ax = plots.snapshot(run, 0.0, ax=axes(), velocities=False)
    segments = {tuple(map(tuple, np.round(s, 9).tolist())) for s in ax.collections[0].get_segments()}
    assert segments == {((0.0, 0.0), (1.0, 0.0)), ((1.0, 0.0), (0.0, 0.0))}


def test_other_laws_have_no_headings():
    with pytest.raises(ArgumentError, match="Algorithm1 has no headings"):
        plots.headings(simulate(Algorithm1(), [[0.0], [7.0]], [[0.0], [0.0]], (0.0, 0.1)), ax=axes())


def test_the_report_draws_what_the_theorem_speaks_of():
    drawn = pictures(scenario("headings-part").run())
    assert len(drawn) == 2
    assert "jointly connected" in drawn[-1].caption
