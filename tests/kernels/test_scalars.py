"""Scalar functions: exact values by hand, slopes against differences, and the ends of the number line."""

from math import cos, inf, isnan, nan, pi, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.kernels import integral_tables, scalars
from flockana.kernels.integral_tables import NODES, integral_panels, panel_edges, series_nodes, series_of


def test_sigma_norm_by_hand():
    assert scalars.sigma_norm(24.0, 1.0) == 4.0  # (√25 − 1)/1
    assert scalars.sigma_norm(0.0, 0.1) == 0.0
    assert scalars.sigma_norm(30.0, 0.1) == pytest.approx(10.0, rel=1e-15)
    # no semi-norm: of twice the length it is not twice as large (misprint-13)
    assert scalars.sigma_norm(14.0**2, 0.1) / scalars.sigma_norm(7.0**2, 0.1) == pytest.approx(2.476, abs=5e-4)
    assert scalars.sigma_norm(1e-20, 0.1) == pytest.approx(5e-21, rel=1e-15)  # √(1+x) − 1 would give 0


def test_sigma_norm_of_huge_arguments():
    assert scalars.sigma_norm(inf, 0.1) == inf
    assert scalars.sigma_norm(1e308, 10.0) == pytest.approx(sqrt(1e307), rel=1e-15)  # ε x² overflows
    assert isnan(scalars.sigma_norm(nan, 0.1))


def test_sigma_1_by_hand():
    assert scalars.sigma_1(0.75) == pytest.approx(0.6, rel=1e-15)
    assert scalars.sigma_1(-4.0 / 3.0) == pytest.approx(-0.8, rel=1e-15)
    assert (scalars.sigma_1(1e200), scalars.sigma_1(-1e200)) == (1.0, -1.0)


@pytest.mark.parametrize(
    ("z", "value"),
    [
        (-1e-300, 0.0),
        (0.0, 1.0),
        (0.2 - 1e-12, 1.0),
        (0.2, 1.0),
        (0.4, 0.5 * (1 + cos(pi / 4))),
        (0.6, 0.5),
        (1.0, 0.0),
        (2.0, 0.0),
    ],
)
def test_bump_by_hand(z, value):
    assert scalars.bump(z, 0.2) == pytest.approx(value, abs=2e-16)


def test_phi_by_hand():
    c = 3.0 / 4.0  # |1 − 4|/√(4·1·4)
    assert scalars.phi(0.0, 1.0, 4.0, c) == 0.0
    assert scalars.phi(4.0 / 3.0 - c, 1.0, 4.0, c) == pytest.approx(0.5 * (5 * 0.8 - 3), rel=1e-14)
    assert scalars.phi(-c, 1.0, 4.0, c) == -1.5
    assert scalars.phi(1e200, 1.0, 4.0, c) == 1.0  # tends to a
    assert scalars.phi(-1e200, 1.0, 4.0, c) == -4.0  # and to −b


def test_phi_integral_keeps_its_digits_where_s_is_small():
    """φ'(0) s²/2 + φ''(0) s³/6: the printed form loses all of it at s = 1e-9."""
    a, b, s = 1.0, 4.0, 1e-9
    c = 0.75
    slope = 0.5 * (a + b) / (1 + c * c) ** 1.5
    assert scalars.phi_integral(s, a, b, c) == pytest.approx(0.5 * slope * s * s, rel=1e-8)
    assert scalars.phi(s, a, b, c) == pytest.approx(slope * s, rel=1e-8)


def test_on_panels_is_the_polynomial_and_keeps_nan():
    panels = integral_panels(lambda z: 3.0 * z**2, np.array([-1.0, 0.5, 2.0]), anchor=2.0, value=8.0)
    for z in (-1.0, -0.3, 0.5, 1.1, 2.0):
        assert integral_tables.on_panels(z, panels) == pytest.approx(z**3, abs=3e-15)
    assert integral_tables.on_panels(9.0, panels) == pytest.approx(8.0, abs=3e-15)  # the nearest end
    assert integral_tables.on_panels(-9.0, panels) == pytest.approx(-1.0, abs=3e-15)
    assert isnan(integral_tables.on_panels(nan, panels))


def test_an_integral_is_summed_from_its_anchor_to_both_sides():
    edges = np.array([-1.0, 0.25, 0.5, 2.0])
    panels = integral_panels(np.exp, edges, anchor=0.25, value=3.0)
    assert np.array_equal(panels[:, :2], np.column_stack([edges[:-1], edges[1:]]))
    for row, left, right in zip(panels, edges[:-1], edges[1:], strict=True):
        for x in np.linspace(-1.0, 1.0, 11):
            z = 0.5 * (left + right) + 0.5 * (right - left) * x
            expected = 3.0 + np.exp(z) - np.exp(0.25)
            assert np.polynomial.polynomial.polyval(x, row[2:]) == pytest.approx(expected, abs=4e-15)


def test_the_series_of_a_chebyshev_polynomial_is_its_own():
    angles = np.arccos(series_nodes())
    series = series_of(np.cos(np.outer(np.arange(NODES), angles)))
    np.testing.assert_allclose(series, np.eye(NODES), atol=3e-15)  # j times the rounding of an angle
    with pytest.raises(ValueError, match="read-only"):
        series_nodes()[0] = 0.0


@given(st.floats(0, 1e4), st.floats(1e-6, 1e4), st.floats(-10, 1e4))
def test_panels_are_no_wider_than_their_distance_from_the_poles(left, width, centre):
    edges = panel_edges(left, left + width, centre)
    assert (edges[0], edges[-1]) == (left, left + width)
    assert np.all(np.diff(edges) > 0.0)
    nearest = np.maximum(0.0, np.maximum(edges[:-1] - centre, centre - edges[1:]))
    assert np.all(np.diff(edges) <= np.hypot(nearest, 1.0) * (1 + 1e-9))
