import matplotlib as mpl
import numpy as np
import pytest

from flockana.plots.scales import PlainScale
from flockana.plots.style import colour_bar, finish, style
from flockana.report.image import placed
from flockana.report.layout import _extents


def drawn(draw, size=(13.0, 4.0)):
    with style(), mpl.rc_context({"axes.titley": 1.0}):
        canvas = placed(draw, size, 80)
        canvas.draw()
    figure = canvas.figure
    own = {ax: [a for a in ax.artists if isinstance(a, PlainScale)] for a in figure.axes for ax in (a, *a.child_axes)}
    scales = {ax: tuple(found) for ax, found in own.items() if found}
    return figure, np.asarray(canvas.buffer_rgba())[:, :, :3], scales


def row_of_curves(figure):
    for k, ax in enumerate(figure.subplots(1, 4)):
        ax.plot([0.0, 60.0], [0.0, 10.0 ** (5 * k - 7)], label="a curve")
        finish(ax, "t (time)", "velocity mismatch")


def wide_legend(figure):
    for j, ax in enumerate(figure.subplots(1, 3)):
        for k in range(4):
            ax.plot([0.0, 1.0], [0.0, k], label=f"coordinate {k}, told" if j == 2 else None)
        finish(ax, "t", "x")


def flocks(figure):
    for k in range(3):
        ax = figure.add_subplot(1, 3, k + 1)
        dots = ax.scatter([0.0, 1.0], [0.0, 5.0], c=[0.0, 1.0])
        ax.set_aspect("equal", adjustable="datalim")
        ax.set_title("t = 0   longest arrow")
        finish(ax, "x (length)", "y (length)")
        if k == 2:
            colour_bar(ax, dots, "strain (length − d)/d")


def space(figure):
    ax = figure.add_subplot(1, 2, 1, projection="3d")
    dots = ax.scatter([0.0, 1.0], [0.0, 5.0], [0.0, 1.0], c=[0.0, 1.0])
    colour_bar(ax, dots, "strain")
    finish(figure.add_subplot(1, 2, 2), "x", "y")


def grid(figure):
    for ax in figure.subplots(2, 2, width_ratios=(2.0, 1.0)).ravel():
        ax.set_title("a title")
        finish(ax, "x", "y")


DRAWINGS = [row_of_curves, wide_legend, flocks, space, grid]


@pytest.mark.parametrize("draw", DRAWINGS)
def test_the_margin_is_blank(draw):
    _, pixels, _ = drawn(draw)
    for edge in (pixels[:1], pixels[-1:], pixels[:, :1], pixels[:, -1:]):
        assert edge.min() == 255


@pytest.mark.parametrize("draw", DRAWINGS)
def test_no_axes_lie_on_what_others_carry(draw):
    figure, _, scales = drawn(draw)
    renderer = figure.canvas.get_renderer()
    boxes = []
    for ax in figure.axes:
        with style():
            parts = np.array([_extents(part, renderer, scales) for part in (ax, *ax.child_axes)])
        boxes.append((parts[:, 0].min(), parts[:, 1].max(), parts[:, 2].min(), parts[:, 3].max()))
    for k, (left, right, low, high) in enumerate(boxes):
        for x0, x1, y0, y1 in boxes[:k]:
            assert right <= x0 + 1.0 or x1 <= left + 1.0 or high <= y0 + 1.0 or y1 <= low + 1.0


def test_axes_of_a_row_are_alike_and_ratios_are_kept():
    figure, _, _ = drawn(row_of_curves)
    sizes = np.array([ax.get_position().size for ax in figure.axes])
    np.testing.assert_allclose(sizes, sizes[:1].repeat(4, axis=0), rtol=1e-9)
    figure, _, _ = drawn(grid)
    widths = [ax.get_position().width for ax in figure.axes]
    assert widths[0] / widths[1] == pytest.approx(2.0, rel=1e-9)


def test_a_shared_power_does_not_lie_on_a_title():
    def draw(figure):
        ax = figure.subplots()
        ax.plot([0.0, 1.0], [0.0, 1e-9])
        ax.set_title("a title")

    figure, _, scales = drawn(draw, (4.0, 3.0))
    (ax,) = figure.axes
    (title,) = (text for text in ax.get_children() if getattr(text, "get_text", str)() == "a title")
    renderer = figure.canvas.get_renderer()
    with style():
        above = max(scale.room(renderer)[3] for scale in scales[ax])
    assert above > 5.0
    assert title.get_window_extent(renderer).y0 >= ax.bbox.y1 + above
