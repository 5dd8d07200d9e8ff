"""Scalar functions: exact values by hand, slopes against differences, and the ends of the number line."""

from math import cos, inf, isnan, nan, pi, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.kernels import alpha as law
from flockana.kernels import scalars, tables
from flockana.kernels.tables import NODES, integral_panels, panel_edges, series_nodes, series_of


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


def test_bump_falls_all_the_way():
    z = np.linspace(0.2, 1.0, 400)
    rho = np.array([scalars.bump(x, 0.2) for x in z])
    assert np.all(np.diff(rho) < 0.0)
    assert rho[-1] == 0.0


def test_phi_by_hand():
    c = 3.0 / 4.0  # |1 − 4|/√(4·1·4)
    assert scalars.phi(0.0, 1.0, 4.0, c) == 0.0
    assert scalars.phi(4.0 / 3.0 - c, 1.0, 4.0, c) == pytest.approx(0.5 * (5 * 0.8 - 3), rel=1e-14)
    assert scalars.phi(-c, 1.0, 4.0, c) == -1.5
    assert scalars.phi(1e200, 1.0, 4.0, c) == 1.0  # tends to a
    assert scalars.phi(-1e200, 1.0, 4.0, c) == -4.0  # and to −b


@given(st.floats(-30, 30), st.floats(0.1, 10), st.floats(1, 100))
def test_phi_is_the_printed_formula(s, a, ratio):
    b = a * ratio
    c = (b - a) / sqrt(4 * a * b)
    printed = 0.5 * ((a + b) * (s + c) / sqrt(1 + (s + c) ** 2) + (a - b))
    assert scalars.phi(s, a, b, c) == pytest.approx(printed, abs=4e-15 * b)


@given(st.floats(-30, 30), st.floats(0.1, 10), st.floats(1, 100))
def test_phi_integral_is_the_printed_antiderivative(s, a, ratio):
    b = a * ratio
    c = (b - a) / sqrt(4 * a * b)

    def printed(x):
        return 0.5 * ((a + b) * sqrt(1 + (x + c) ** 2) + (a - b) * x)

    assert scalars.phi_integral(s, a, b, c) == pytest.approx(
        printed(s) - printed(0.0), abs=1e-14 * b * (abs(s) + c + 1)
    )


def test_phi_integral_keeps_its_digits_where_s_is_small():
    """φ'(0) s²/2 + φ''(0) s³/6: the printed form loses all of it at s = 1e-9."""
    a, b, s = 1.0, 4.0, 1e-9
    c = 0.75
    slope = 0.5 * (a + b) / (1 + c * c) ** 1.5
    assert scalars.phi_integral(s, a, b, c) == pytest.approx(0.5 * slope * s * s, rel=1e-8)
    assert scalars.phi(s, a, b, c) == pytest.approx(slope * s, rel=1e-8)


PAR = np.array([0.1, 0.2, 5.0, 9.0, 4.0 / sqrt(180.0), 14.289915602982238, 18.383093559370867, 0.0, 0.0, 1.0])


@pytest.mark.parametrize("z", [0.3, 3.0, 3.9, 8.0, 14.2, 16.0, 18.3])
def test_phi_alpha_slope_is_the_derivative(z):
    """Complex steps do not run through the branches: fourth-order differences, error about 1e-12 of the slope."""
    f, h = law.phi_alpha, 1e-3
    difference = (8 * (f(z + h, PAR) - f(z - h, PAR)) - (f(z + 2 * h, PAR) - f(z - 2 * h, PAR))) / (12 * h)
    assert law.phi_alpha_slope(z, PAR) == pytest.approx(difference, abs=1e-10)


@pytest.mark.parametrize("distance", [0.05, 1.0, 3.0, 6.9, 7.6, 8.3])
def test_pair_alpha_slope_is_the_derivative_in_s2(distance):
    s2, h = distance**2, 1e-4 * distance**2
    w = [law.pair_alpha(s2 + k * h, PAR)[0] for k in (-2, -1, 1, 2)]
    difference = (8 * (w[2] - w[1]) - (w[3] - w[0])) / (12 * h)
    assert law.pair_alpha_slope(s2, PAR) == pytest.approx(difference, rel=1e-8)


def test_pair_alpha_is_phi_times_the_gradient_of_the_sigma_norm():
    s2 = 30.0  # ‖·‖_σ = 10, √(1 + ε s²) = 2
    w, rho = law.pair_alpha(s2, PAR)
    assert w == pytest.approx(law.phi_alpha(10.0, PAR) / 2.0, rel=1e-14)
    assert rho == pytest.approx(0.5 * (1 + cos(pi * (10.0 / PAR[6] - 0.2) / 0.8)), rel=1e-14)


def test_pair_beta_by_hand():
    par = np.array([1.0, 0.5, 4.0, 0.0, 1.0])  # ε = 1, h = 0.5, d_β = 4, ℓ = 1
    w, b = law.pair_beta(8.0, par)  # ‖·‖_σ = 2, z/d_β = h: still 1
    assert b == 1.0
    assert w == pytest.approx((-2.0 / sqrt(5.0) - 1.0) / 3.0, rel=1e-15)
    assert law.pair_beta(24.0, par) == (0.0, 0.0)


def test_on_panels_is_the_polynomial_and_keeps_nan():
    panels = integral_panels(lambda z: 3.0 * z**2, np.array([-1.0, 0.5, 2.0]), anchor=2.0, value=8.0)
    for z in (-1.0, -0.3, 0.5, 1.1, 2.0):
        assert tables.on_panels(z, panels) == pytest.approx(z**3, abs=3e-15)
    assert tables.on_panels(9.0, panels) == pytest.approx(8.0, abs=3e-15)  # the nearest end
    assert tables.on_panels(-9.0, panels) == pytest.approx(-1.0, abs=3e-15)
    assert isnan(tables.on_panels(nan, panels))


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
