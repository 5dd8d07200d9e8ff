import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from flockana.plots.axis_scales import PlainScale, plain, plain_scales
from flockana.plots.style import colour_bar, style


def figure_with(draw):
    figure = Figure(figsize=(5.0, 4.0), dpi=100)
    figure.set_layout_engine("none")
    canvas = FigureCanvasAgg(figure)
    ax = figure.add_axes((0.2, 0.2, 0.6, 0.6))
    draw(ax)
    return figure, canvas, ax


def pixels_of(canvas):
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3].astype(int)


DRAWINGS = {
    "linear": lambda ax: ax.plot([-150.0, 220.0], [0.1, 0.9]),
    "a shared power": lambda ax: ax.plot([0.0, 1.0], [1e-7, 6e-7]),
    "logarithmic": lambda ax: ax.semilogy([0.0, 1.0], [1e-18, 1e3]),
    "one decade": lambda ax: ax.loglog([2.0, 9.0], [1.0, 3.0]),
    "no ticks": lambda ax: ax.set(xticks=[], yticks=[]),
    "names": lambda ax: ax.set(xlabel="x (length)", ylabel="Ẽ, deviation energy"),
    "no grid": lambda ax: ax.grid(visible=False),
}


@pytest.mark.parametrize("draw", DRAWINGS.values(), ids=DRAWINGS)
def test_ticks_stand_where_matplotlib_draws_them_with_the_same_numbers(draw):
    with style():
        _, theirs, ax = figure_with(draw)
        theirs.draw()
        axes = {"x": ax.xaxis, "y": ax.yaxis}
        expected = {
            name: [
                (plain(tick.label1.get_text()), ax.transData.transform((tick.get_loc(),) * 2)["xy".index(name)])
                for tick in axis._update_ticks()
            ]
            for name, axis in axes.items()
        }
        figure, ours, ax = figure_with(draw)
        scales = plain_scales(figure)[ax]
        ours.draw()
        for scale in scales:
            kinds = [scale.ticks(which) for which in ("major", "minor")]
            found = [pair for ticks in kinds for pair in zip(ticks.numbers, ticks.at.tolist(), strict=True)]
            assert [text for text, _ in found] == [text for text, _ in expected[scale.name]]
            np.testing.assert_allclose([at for _, at in found], [at for _, at in expected[scale.name]], atol=1e-6)


@pytest.mark.parametrize("draw", DRAWINGS.values(), ids=DRAWINGS)
def test_it_looks_the_same_but_for_the_typesetting_and_takes_the_room_that_it_says(draw):
    with style():
        theirs = pixels_of(figure_with(draw)[1])
        figure, canvas, ax = figure_with(draw)
        scales = plain_scales(figure)[ax]
        ours = pixels_of(canvas)
        assert (np.abs(theirs - ours).max(axis=2) > 60).mean() < 0.01  # numbers and names, a pixel up or down
        inked = np.argwhere((255 - ours).max(axis=2) > 30)
        rooms = np.max([scale.room(canvas.get_renderer()) for scale in scales], axis=0)
    box, height = ax.bbox, canvas.get_width_height()[1]
    low, high = inked.min(axis=0), inked.max(axis=0) + 1
    assert low[1] >= box.x0 - rooms[0] - 2.0
    assert high[1] <= box.x1 + rooms[1] + 2.0
    assert height - high[0] >= box.y0 - rooms[2] - 2.0
    assert height - low[0] <= box.y1 + rooms[3] + 2.0


def test_a_colour_bar_has_its_numbers_on_the_right():
    with style():
        figure, canvas, ax = figure_with(lambda ax: None)
        dots = ax.scatter([0.0, 1.0], [0.0, 1.0], c=[0.0, 1.0])
        ax.set_position((0.1, 0.1, 0.6, 0.8))
        bar = colour_bar(ax, dots, "strain")
        scales = plain_scales(figure)
        canvas.draw()
    (scale,) = (scale for scale in scales[bar.ax] if scale.name == "y")
    assert isinstance(scale, PlainScale)
    left, right, _, _ = scale.room(canvas.get_renderer())
    assert (scale.side, left) == ("right", 0.0)
    assert right > 20.0
    assert bar.ax.get_position().x0 > ax.get_position().x1
