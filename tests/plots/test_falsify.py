import numpy as np
import pytest

from flockana import falsify, plots, scenario
from flockana.base.errors import ArgumentError
from flockana.plots.falsify import search_history
from tests.plots.artists import axes

MARGINS = np.array([3.0, np.nan, 1.0, 2.0, -0.5])
BEST = np.fmin.accumulate(MARGINS)


def drawn(ax):
    return {line.get_label(): line.get_xydata() for line in ax.lines}


def test_runs_the_least_so_far_and_the_refuted_are_where_they_are():
    ax = search_history(MARGINS, BEST, found=[4], label="os-1:iii", ax=axes(), title="a search")
    found = drawn(ax)
    np.testing.assert_array_equal(found["one run"], [[1, 3.0], [3, 1.0], [4, 2.0], [5, -0.5]])
    np.testing.assert_array_equal(
        found["smallest margin so far"], np.column_stack([np.arange(1, 6), [3.0, 3.0, 1.0, 1.0, -0.5]])
    )
    np.testing.assert_array_equal(found["refuted"], [[5, -0.5]])
    np.testing.assert_array_equal(found["no margin"][:, 0], [2])
    assert ax.get_ylabel() == "margin of os-1:iii"
    assert ax.get_yscale() == "linear"
    ax.figure.canvas.draw()


def test_margins_of_many_sizes_have_an_axis_that_shows_them():
    values = np.array([1e6, 10.0, 1.0, -100.0])
    ax = search_history(values, values, ax=axes())
    assert ax.get_yscale() == "symlog"
    assert "refuted" not in drawn(ax)
    assert "no margin" not in drawn(ax)
    ax.figure.canvas.draw()


@pytest.mark.parametrize(("margins", "best"), [([1.0], [1.0, 2.0]), ([], []), ([[1.0]], [[1.0]])])
def test_bad_data_is_named(margins, best):
    with pytest.raises(ArgumentError, match="expected one number per run in each"):
        search_history(margins, best, ax=axes())


def test_a_search_is_drawn_by_its_claim():
    found = falsify("collision-energy", scenario("head-on"), claim="twice", budget=40)
    ax = plots.falsification(found, ax=axes())
    curves = drawn(ax)
    np.testing.assert_array_equal(curves["smallest margin so far"][:, 1], found.history)
    assert curves["refuted"][:, 0].tolist() == [k + 1 for k in found.refuting("twice")]
    assert ax.get_ylabel() == "margin of collision-energy:twice"
