import re

import numpy as np
import pytest

from flockana.report.charts import _BELOW, _HEIGHT, _LEFT, _RIGHT, _TOP, _WIDTH, Chart, Curve, _path, _round


def points(text, kind="c0"):
    data = re.search(rf'class="curve {kind}" d="([^"]*)"', text)[1]
    return np.array([[float(v) for v in pair.split()] for pair in re.split("[ML]", data)[1:]])


def test_a_line_lies_where_its_numbers_say():
    text = Chart("x", np.array([0.0, 1.0, 2.0]), (Curve(np.array([0.0, 1.0, 3.0])),)).svg()
    x, y = points(text).T
    np.testing.assert_allclose(x, np.linspace(_LEFT, _WIDTH - _RIGHT, 3), atol=0.5)
    assert y[0] == pytest.approx(_HEIGHT - _BELOW, abs=1.0)  # 0 is the lower edge
    assert (y[0] - y[1]) / (y[0] - y[2]) == pytest.approx(1.0 / 3.0, abs=0.005)
    assert y[2] > _TOP


def test_decades_are_equally_long_and_what_is_not_positive_is_left_out():
    text = Chart("x", np.arange(4.0), (Curve(np.array([1.0, 0.0, 10.0, 100.0])),), logarithmic=True).svg()
    y = points(text)[:, 1]
    assert len(y) == 3
    assert y[0] - y[1] == pytest.approx(y[1] - y[2], abs=1.0)
    assert ">1e1<" in text


@pytest.mark.parametrize("missing", [slice(0), slice(2341, 2350)])
def test_a_peak_of_one_sample_is_drawn_whatever_is_missing_beside_it(missing):
    values = np.zeros(5001)
    values[missing] = np.nan
    values[2345] = 1.0
    drawn = points(Chart("x", np.arange(5001.0), (Curve(values),)).svg())
    assert drawn[:, 1].min() < _TOP + 0.1 * _HEIGHT < drawn[:, 1].max()
    assert len(drawn) < 200


def test_levels_are_named_and_words_escaped():
    text = Chart("<x>", np.arange(3.0), (Curve(np.arange(3.0), "a & b"),), levels=((1.0, "bound"),)).svg()
    assert "bound</text>" in text
    assert "&lt;x&gt; over time" in text
    assert "a &amp; b" in text


@pytest.mark.parametrize("values", [np.zeros(3), np.full(3, 7.0), np.full(3, np.nan)])
def test_what_does_not_change_or_is_not_there_makes_no_error(values):
    for logarithmic in (False, True):
        assert "nan" not in Chart("x", np.arange(3.0), (Curve(values),), logarithmic).svg()


def test_numbers_on_the_axis_are_told_apart():
    for low, high in ((0.0, 1e-9), (99999.0, 100001.0), (-1e6, 1e7), (1.0, 1.0004)):
        texts = [text for _, text in _round(low, high, 4)]
        assert len(set(texts)) == len(texts) >= 2
        assert [float(text) for text in texts] == pytest.approx([at for at, _ in _round(low, high, 4)], rel=1e-3)


def test_a_path_breaks_where_points_are_not_finite_and_leaves_out_those_on_a_line():
    assert _path(np.arange(4.0), np.array([0.0, 1.0, np.nan, 3.0])) == "M0 0L1 1M3 3"
    assert _path(np.arange(4.0), np.array([5.0, 5.0, 5.0, 7.0])) == "M0 5L2 5L3 7"
