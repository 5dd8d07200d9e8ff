import numpy as np
import pytest
import xarray
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.ensemble import PHASES
from flockana.plots import ensemble as plots
from flockana.plots.palette import GREEN, ORANGE, VERMILLION


@pytest.fixture
def ax():
    return Figure().add_subplot()


def a_table(**dims):
    """Shares 0.5 and 0.25 in every entry, intervals 0.1 below and 0.2 above."""
    coords = {**dims, "claim": ["a:i", "a:ii"], "of": ["verified", "refuted"]}
    shape = tuple(len(values) for values in coords.values())
    share = np.broadcast_to([0.5, 0.25], shape).copy()
    found = {"share": share, "low": share - 0.1, "high": share + 0.2}
    data = {name: (tuple(coords), values) for name, values in found.items()}
    data["runs"] = (tuple(coords)[:-1], np.full(shape[:-1], 8))
    return xarray.Dataset(data, coords, {"level": 0.9})


def test_shares_stand_where_they_are_with_their_intervals(ax):
    drawn = plots.share_against(a_table(n=[10.0, 20.0, 40.0]), "n", claims=["a:ii"], of="refuted", ax=ax, title="t")
    assert drawn is ax
    line = ax.lines[0]
    np.testing.assert_array_equal(line.get_xdata(), [10.0, 20.0, 40.0])
    np.testing.assert_array_equal(line.get_ydata(), [0.25] * 3)
    bars = [segment[:, 1].tolist() for segment in ax.collections[0].get_segments()]
    np.testing.assert_allclose(bars, [[0.15, 0.45]] * 3)
    assert ax.get_ylabel() == "share of runs refuted, 90 % intervals"
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["a:ii"]


def apart(table):
    """The table with a share of its own for each claim."""
    own = 0.01 * xarray.DataArray(np.arange(table.sizes["claim"]), dims="claim")
    return table.assign(share=table.share - own)


def test_curves_that_share_a_parameter_are_set_apart_or_share_a_name_and_names_get_places(ax):
    alike = plots.share_against(a_table(push=[1.0, 10.0]), "push", ax=Figure().add_subplot())
    assert (alike.get_legend_handles_labels()[1], alike.get_xscale()) == (["a:i, a:ii"], "log")
    plots.share_against(apart(a_table(push=[False, True])), "push", ax=ax)
    first, second = (line.get_xdata() for line in ax.lines if line.get_marker() in "os")
    assert (first < second).all()
    np.testing.assert_allclose(0.5 * (first + second), [0.0, 1.0])
    assert [text.get_text() for text in ax.get_xticklabels()] == ["False", "True"]


def test_bars_show_both_shares_from_the_top(ax):
    plots.share_bars(a_table(), ax=ax)
    marks = {line.get_label(): line for line in ax.lines}
    assert marks["verified"].get_xdata().tolist() == [0.5, 0.5]
    assert marks["refuted"].get_xdata().tolist() == [0.25, 0.25]
    assert np.round(marks["verified"].get_ydata()).tolist() == [1.0, 0.0]
    assert [text.get_text() for text in ax.get_yticklabels()] == ["a:i", "a:ii"]
    np.testing.assert_allclose(ax.collections[0].get_segments()[0][:, 0], [0.4, 0.7])
    assert ax.get_xlabel() == "share of 8 runs, 90 % intervals"


def test_a_distribution_rises_by_one_run_at_each_value(ax):
    plots.distribution({"a": [3.0, np.nan, 1.0, 2.0, 2.0]}, quantity="δ", bound=2.5, ax=ax)
    curve = ax.lines[0]
    assert curve.get_xdata().tolist() == [1.0, 1.0, 2.0, 2.0, 3.0]
    assert curve.get_ydata().tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert curve.get_drawstyle() == "steps-post"
    assert curve.get_label() == "a (4 runs)"
    assert [line.get_xdata()[0] for line in ax.lines if line.get_label() == "2.5"] == [2.5]


def test_values_without_a_place_on_a_logarithmic_axis_still_count(ax):
    plots.distribution({"a": [0.0, 0.0, 1.0, 10.0]}, quantity="δ", log=True, ax=ax)
    assert ax.lines[0].get_ydata().tolist() == [0.5, 0.75, 1.0]
    assert ax.lines[0].get_label() == "a (4 runs, 2 at 0)"


def test_a_cell_is_divided_by_the_shares_of_its_seeds(ax):
    codes = np.array([[[0, 0, 1, 2]], [[0, 0, -1, 2]]], dtype=np.int8)  # x, y, seed
    coords = {"ratio": [0.1, 0.2], "density": [1.0]}
    phase = xarray.DataArray(codes, coords, ("ratio", "density", "seed"), attrs={"flag_meanings": " ".join(PHASES)})
    plots.phase_diagram(phase.transpose("seed", "density", "ratio"), "ratio", "density", ax=ax, labels=("x", "y"))
    patches = [(p.get_x(), p.get_width(), p.get_y(), p.get_facecolor()) for p in ax.patches]
    colours = [to_rgba(colour) for colour in (GREEN, ORANGE, VERMILLION)]
    expected = [(-0.5, 0.5), (0.0, 0.25), (0.25, 0.25), (0.5, 2 / 3), (7 / 6, 1 / 3)]
    np.testing.assert_allclose([patch[:2] for patch in patches], expected)
    assert [patch[3] for patch in patches] == [*colours, colours[0], colours[2]]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["flocking", "fragmentation", "collapse"]
    assert ([text.get_text() for text in ax.get_xticklabels()], ax.get_xlabel()) == (["0.1", "0.2"], "$x$")
    hatches = {p.get_hatch() for p in ax.patches}
    assert len(hatches) == 3  # told apart without colour


@pytest.mark.parametrize(
    ("draw", "kind", "message"),
    [
        (lambda ax: plots.share_against(a_table(n=[1], m=[2]), "n", ax=ax), ArgumentError, "the table is over m, n"),
        (lambda ax: plots.share_bars(a_table(n=[1]), ax=ax), ArgumentError, "the table is over n: expected none"),
        (lambda ax: plots.share_bars(a_table(), claims=["a:iii"], ax=ax), UnknownNameError, "unknown claim 'a:iii'"),
        (lambda ax: plots.share_bars(a_table(), claims=[], ax=ax), ArgumentError, "no claims"),
        (lambda ax: plots.share_against(a_table(n=[1]), "n", of="vacuous", ax=ax), ArgumentError, "of = 'vacuous'"),
        (lambda ax: plots.distribution({"a": [np.nan]}, quantity="δ", ax=ax), ArgumentError, "no finite value to draw"),
        (
            lambda ax: plots.phase_diagram(xarray.DataArray(np.zeros(2), dims="seed"), "x", "y", ax=ax),
            ArgumentError,
            "expected x, y and seed",
        ),
    ],
)
def test_what_cannot_be_drawn_is_told(draw, kind, message, ax):
    with pytest.raises(kind, match=message):
        draw(ax)


def test_more_curves_than_can_be_told_apart_are_refused(ax):
    table = a_table(n=[1.0, 2.0])
    many = xarray.concat([table.assign_coords(claim=[f"{k}:i", f"{k}:ii"]) for k in range(4)], dim="claim")
    with pytest.raises(ArgumentError, match="8 claims: expected at most 7"):
        plots.share_against(apart(many), "n", ax=ax)


@pytest.mark.parametrize(
    ("values", "scale"),
    [([0.01, 0.1, 1.0, 10.0], "log"), ([1, 10, 100], "log"), ([2, 8, 14, 20], "linear"), ([0.0, 1.0, 10.0], "linear")],
)
def test_marks_stand_at_their_values_on_an_axis_that_suits_them(ax, values, scale):
    plots.share_against(a_table(n=values), "n", claims=["a:i"], ax=ax)
    assert ax.get_xscale() == scale
    marks = ax.lines[0].get_xdata()
    np.testing.assert_allclose(marks, values, rtol=1e-12)
