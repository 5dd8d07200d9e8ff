import numpy as np
import pytest

from flockana.base.errors import ArgumentError
from flockana.player.run_codec import Packed, decode, encode


def test_numbers_come_back_as_float32_rounds_them():
    values = np.random.default_rng(0).normal(size=(50, 7, 2)) * 10.0 ** np.arange(-3, 4)[:, None]
    values[0, 0] = 0.0, -1e-30
    header, arrays = decode(encode({"title": "Ω <b>"}, {"q": Packed(values), "t": Packed(np.arange(50.0))}))
    assert header == {"title": "Ω <b>"}
    np.testing.assert_array_equal(arrays["q"], values.astype(np.float32).astype(float))
    np.testing.assert_array_equal(arrays["t"], np.arange(50.0))


def test_with_a_step_they_come_back_to_half_of_it():
    values = np.cumsum(np.random.default_rng(1).normal(size=(200, 3, 2)), axis=0) - 40.0
    coarse = decode(encode({}, {"q": Packed(values, 0.01)}))[1]["q"]
    assert 0.004 < np.abs(coarse - values).max() <= 0.005 * (1.0 + 1e-9)


def test_one_row_none_and_whole_numbers():
    arrays = {
        "one": Packed(np.array([[3.0]])),
        "none": Packed(np.zeros((0, 2))),
        "pairs": Packed([[0, 1], [7, 2]], 1.0),
    }
    back = decode(encode({}, arrays))[1]
    assert (back["one"].tolist(), back["none"].shape, back["pairs"].tolist()) == ([[3.0]], (0, 2), [[0, 1], [7, 2]])


def test_slow_motion_costs_little():
    t = np.linspace(0.0, 1.0, 300)[:, None, None]
    values = np.arange(300.0).reshape(1, 150, 2) + 0.1 * t
    assert len(encode({}, {"q": Packed(values)})) < 0.6 * 4 * values.size


@pytest.mark.parametrize(
    ("packed", "match"),
    [
        (Packed(np.array([[np.nan]])), "q: expected finite numbers"),
        (Packed(np.array([[1e39]])), "that float32 holds"),
        (Packed(np.array([[0.0], [1.0]]), 1e-12), "expected a longer step"),
    ],
)
def test_what_does_not_fit_is_refused(packed, match):
    with pytest.raises(ArgumentError, match=match):
        encode({}, {"q": packed})


@pytest.mark.parametrize("damage", [b"", b"FLK2", b"FLK1 no zlib"])
def test_other_bytes_are_refused(damage):
    with pytest.raises(ArgumentError, match="expected those of a run"):
        decode(damage)
    with pytest.raises(ArgumentError, match="expected those of a run"):
        decode(encode({}, {"q": Packed(np.ones((9, 9)))})[:-9])
