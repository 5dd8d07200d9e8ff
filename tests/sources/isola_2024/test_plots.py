import numpy as np
import pytest

from flockana import Algorithm1, Trajectory, ZoneFlocking, plots, scenario, simulate
from flockana.base.errors import ArgumentError
from flockana.report.figures import pictures
from tests.plots.artists import axes


def a_path_that_falls_apart():
    q = np.array([[[0.0, 0.0], [7.0, 0.0], [14.0, 0.0]], [[0.0, 0.0], [7.0, 0.0], [99.0, 0.0]]])
    return Trajectory(np.array([0.0, 1.0]), q, 0.0 * q, 0.0 * q, Algorithm1())


def test_the_three_curves():
    bare, typeset, true, *_ = plots.rank_connectivity(a_path_that_falls_apart(), ax=axes()).get_lines()
    np.testing.assert_allclose(bare.get_ydata(), [2 / 3, 2 / 3])  # of a path of three, and of one link and one agent
    np.testing.assert_allclose(typeset.get_ydata(), [1.0, 1 / 3])  # 1 1 / 1 1 and 0: rank 1
    np.testing.assert_allclose(true.get_ydata(), [1.0, 0.5])


def test_a_law_without_a_range_is_refused():
    run = simulate(ZoneFlocking(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0))
    with pytest.raises(ArgumentError, match="expected one whose agents interact within a range"):
        plots.rank_connectivity(run, ax=axes())


def test_the_report_draws_it_of_the_projects_map():
    entry = scenario("msn-case2-printed")
    drawn = pictures(entry.run(), entry.instants)
    assert len(drawn) == 5
    assert "rank(A)/n" in drawn[-1].caption
    assert "6 instants that the source shows" in drawn[0].caption
