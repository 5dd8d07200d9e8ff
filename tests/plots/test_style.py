import inspect

import numpy as np
import pytest
from matplotlib.figure import Figure

from flockana import plots
from flockana.plots.style import colour_bar, finish, finish_over_time, write_title
from tests.plots.artists import a_run
from tests.refused import refused


@pytest.fixture
def ax():
    return Figure().add_subplot()


def test_axes_are_named_and_labels_make_a_legend(ax):
    ax.plot([0.0, 1.0], [1.0, 2.0])
    assert finish(ax, "x (length)", "y (length)") is ax
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_legend()) == ("$x$ (length)", "$y$ (length)", None)
    ax.plot([0.0, 1.0], [2.0, 1.0], label="a line")
    (text,) = finish(ax).get_legend().get_texts()
    assert (text.get_text(), ax.get_xlabel()) == ("a line", "$x$ (length)")


def test_a_drawing_over_time_goes_from_the_first_time_to_the_last(ax):
    finish_over_time(ax, np.array([2.0, 3.0, 7.0]), "H, energy")
    assert (ax.get_xlim(), ax.get_xlabel(), ax.get_ylabel()) == ((2.0, 7.0), "$t$ (time)", "$H$, energy")
    before = ax.get_xlim()
    assert finish_over_time(ax, np.array([5.0]), "").get_xlim() == before  # one instant has no extent


def test_axes_that_others_made_get_titles_legends_and_colour_bars_in_the_style():
    ax = Figure().add_subplot()
    ax.plot([0, 1], [0, 1], label="γ-agent")
    finish(ax, "t (time)", "‖u‖")
    write_title(ax, "ζ = 1")
    bar = colour_bar(ax, ax.scatter([0, 1], [0, 1], c=[0, 1]), "c1γ").ax
    title = ax.title if ax.get_title() else ax._left_title
    assert (title.get_text(), title.get_fontsize()) == (r"$\zeta$ = 1", 10)
    assert (ax.get_xlabel(), ax.get_ylabel(), bar.get_ylabel()) == ("$t$ (time)", r"$\Vert u\Vert$", r"$c_1^\gamma$")
    assert (ax.get_legend().get_texts()[0].get_text(), ax.lines[0].get_label()) == (r"$\gamma$-agent", "γ-agent")
    assert ax.get_legend().get_frame().get_edgecolor()[3] == 0.0
    assert (bar.yaxis.label.get_fontsize(), bar.get_yticklabels()[0].get_fontsize()) == (9, 8)


@pytest.mark.parametrize(("words", "rows"), [("a line", 1), ("a line of some twenty letters", 3)])
def test_a_legend_is_hardly_wider_than_its_axes(words, rows):
    ax = Figure(figsize=(4.4, 3.4)).add_subplot()
    for k in range(4):
        ax.plot([0, k], [0, 1], label=words)
    legend = finish(ax).get_legend()
    assert legend.get_window_extent().width <= 1.15 * ax.get_window_extent().width
    assert len({round(text.get_window_extent().y0) for text in legend.get_texts()}) <= rows


def test_a_name_that_would_take_three_lines_becomes_its_symbol_and_unit():
    low, high = (Figure(figsize=(4.0, height)).add_subplot() for height in (2.0, 6.0))
    for ax in (low, high):
        finish(ax, y="K\u0303, normalised velocity mismatch (length²/time²)")
    assert high.get_ylabel() == "$\\tilde K$, normalised velocity mismatch (length$^2$/time$^2$)"
    assert low.get_ylabel() == "$\\tilde K$ (length$^2$/time$^2$)"
    assert low.yaxis.label.get_window_extent().height <= 1.1 * low.get_window_extent().height


OF_A_RUN = ["snapshot", "centre_path", "energy_residual", "distances"]


@pytest.mark.slow
@pytest.mark.parametrize("name", OF_A_RUN)
@pytest.mark.parametrize("m", [2, 3])
def test_nothing_that_is_written_beside_a_drawing_is_cut_off(name, m):
    """In the figure that the function makes: labels, numbers, titles, legends and colour bars."""
    drawn = getattr(plots, name)(a_run(m))
    figure = np.ravel(drawn)[0].figure
    figure.canvas.draw()
    for ax in figure.axes:
        box = ax.get_tightbbox(figure.canvas.get_renderer())
        assert min(box.x0, box.y0) >= -1.0  # a pixel
        assert box.x1 <= figure.bbox.x1 + 1.0
        assert box.y1 <= figure.bbox.y1 + 1.0


OF_FILES = {"animate", "animate_mode"}  # films: of something, to a path
OTHERS = {"animation", "mode_title", "save", "style", "subplots"}
DRAWING = [name for name in plots.__all__ if inspect.isfunction(getattr(plots, name)) and name not in OF_FILES | OTHERS]


def test_what_draws_takes_its_data_and_then_options_by_name_one_of_which_is_where():
    assert len(DRAWING) > 45
    for name in DRAWING:
        parameters = inspect.signature(getattr(plots, name)).parameters.values()
        data = [one for one in parameters if one.kind is not one.KEYWORD_ONLY]
        bare = all(one.default is one.empty or (one.name in ("p", "time") and one.default is None) for one in data)
        options = {one.name: one.default for one in parameters if one.kind is one.KEYWORD_ONLY}
        assert (1 <= len(data) <= 3, bare, options["ax"], "axes" in options) == (True, True, None, False), name


test_a_grid_has_rows_and_columns = refused(
    ((0,), "rows = 0: expected"), ((1, "x"), "columns = 'x': expected"), make=lambda grid: plots.subplots(*grid)
)
