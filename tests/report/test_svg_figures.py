import re

import matplotlib as mpl
import numpy as np
import pytest

from flockana.plots.axis_scales import PlainScale
from flockana.plots.style import colour_bar, finish, style
from flockana.report.svg_figures import _short, named, placed, svg


def lines(figure):
    ax = figure.subplots()
    ax.plot([0.0, 1.0], [0.0, 1.0], "o", color="#0072B2", label="a <curve>")
    ax.legend()


def test_colours_are_the_page_s_and_texts_are_texts():
    text = svg(lines, (4.0, 3.0))
    assert text.startswith('<svg viewBox="0 0 288 216" class="drawn">')
    assert "var(--blue)" in text
    assert "a &lt;curve&gt;</text>" in text
    assert not re.search(r"#0072b2|#ffffff|#222222|<style|http", text)


def test_ids_are_unique_in_a_page_and_lead_where_they_did():
    text = svg(lines, (4.0, 3.0))
    first, second = (named(text, 'a "name"', number) for number in (1, 2))
    ids = [re.findall(r' id="([^"]*)"', each) for each in (first, second)]
    assert ids[0]
    assert not set(ids[0]) & set(ids[1])
    assert set(re.findall(r'(?:href="#|url\(#)([^")]+)', first)) == set(ids[0])
    assert 'aria-label="a &quot;name&quot;"' in first


def test_long_paths_lose_repeated_points_and_hundredths_short_ones_only_spaces():
    assert _short("M 0.50 -1.25 C 0 1.00 10 20.05 3.10 4 z ") == "M0.5 -1.25C0 1 10 20.05 3.1 4z"
    points = "M 0 0 " + "L 10.00 20.06 " * 40 + "L 10.04 20.09 L 3.19 100"
    assert _short(points) == "M0 0L10 20L3.1 100"


def wide_legend(figure):
    for j, ax in enumerate(figure.subplots(1, 3)):
        for k in range(4):
            ax.plot([0.0, 1.0], [0.0, k], label=f"coordinate {k}, told" if j == 2 else None)
        finish(ax, "t", "x")


def flock_with_a_bar(figure):
    ax = figure.subplots()
    dots = ax.scatter([0.0, 1.0], [0.0, 5e-9], c=[0.0, 1.0])
    ax.set_title("t = 0   longest arrow")
    finish(ax, "x (length)", "y (length)")
    colour_bar(ax, dots, "strain (length − d)/d")


@pytest.mark.parametrize("draw", [wide_legend, flock_with_a_bar])
def test_all_that_axes_carry_is_in_the_figure_and_a_shared_power_on_no_title(draw):
    with style(), mpl.rc_context({"axes.titley": 1.0}):
        canvas = placed(draw, (9.0, 3.0), 80)
        canvas.draw()
    pixels, ax = np.asarray(canvas.buffer_rgba())[:, :, :3], canvas.figure.axes[0]
    for edge in (pixels[:1], pixels[-1:], pixels[:, :1], pixels[:, -1:]):
        assert edge.min() == 255
    if title := ax.get_title("left") or ax.get_title():
        (drawn,) = (text for text in ax.get_children() if getattr(text, "get_text", str)() == title)
        above = max(scale.room(canvas.get_renderer())[3] for scale in ax.artists if isinstance(scale, PlainScale))
        assert above > 5.0
        assert drawn.get_window_extent(canvas.get_renderer()).y0 >= ax.bbox.y1 + above
