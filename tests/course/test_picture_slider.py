import base64
import io
import json
import re
from html import unescape

import pytest
from PIL import Image

from flockana.base.errors import ArgumentError
from flockana.course.picture_slider import film, slider


def bar(ax, height):
    ax.bar([0], [height], color="black", width=2.0)
    ax.set(xlim=(-1, 1), ylim=(0, 1))


def dark(picture):
    """The share of black."""
    grey = Image.open(io.BytesIO(picture)).convert("L")
    return sum(grey.histogram()[:64]) / (grey.width * grey.height)


def test_a_picture_for_each_value_with_the_same_margins():
    found = slider(bar, [0.25, 0.5, 1.0], name="height", title="a <bar>", size=(3.0, 2.0), start=1)
    shares = [dark(each) for each in found.pictures]
    assert shares[1] - shares[0] == pytest.approx((shares[2] - shares[0]) / 3.0, rel=0.05)
    assert shares[0] > 0.1
    assert {Image.open(io.BytesIO(each)).size for each in found.pictures} == {found.size} == {(270, 180)}
    assert sum(len(each) for each in found.pictures) < 20_000
    assert found.texts == ("0.25", "0.5", "1")


def test_the_margins_are_those_of_the_first_picture():
    """Longer numbers beside the axes do not move them: the picture would tremble."""

    def scaled(ax, top):
        ax.set(ylim=(0, top), yticks=[top], facecolor="black")

    first, second = (dark(each) for each in slider(scaled, [1.0, 12345678.0], name="top", title="a scale").pictures)
    assert abs(first - second) < 0.02


def test_its_page_needs_nothing_and_starts_where_it_should():
    found = slider(bar, [0.25, 0.5, 1.0], name="height", title="a <bar>", start=1)
    page = found.html()
    assert "http" not in page
    assert 'max="2" value="1" aria-label="height"' in page
    assert 'alt="a &lt;bar&gt;"' in page
    listed = json.loads(re.search(r"const pictures = (\[.*?\])", page)[1])
    assert [base64.b64decode(each.partition(",")[2]) for each in listed] == list(found.pictures)
    assert f'<img alt="a &lt;bar&gt;" src="{listed[1]}">' in page
    assert "<button" not in page
    played = film(bar, [0.5, 1.0], name="height", title="a bar", seconds=3.0).html()
    assert '<button type="button">Play</button>' in played
    assert "seconds = 3.0" in played
    assert page.count("<bar>") == 0
    frame = found._repr_html_()
    assert unescape(re.search(r'srcdoc="([^"]*)"', frame)[1]) == page
    assert 'sandbox="allow-scripts"' in frame


@pytest.mark.parametrize(
    ("make", "values", "option", "message"),
    [
        *((slider, values, {}, "at least two values, start one of them") for values in ([], [1.0])),
        *((slider, [0.5, 1.0], {"start": start}, "at least two values, start one of them") for start in (2, -1)),
        (film, [0.5, 1.0], {"seconds": 0.0}, "seconds = 0"),
    ],
)
def test_values_are_two_and_a_film_takes_time(make, values, option, message):
    with pytest.raises(ArgumentError, match=message):
        make(bar, values, name="height", title="a bar", **option)
