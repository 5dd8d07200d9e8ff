import control
import numpy as np
import pytest
from matplotlib.figure import Figure

from flockana.base.errors import ArgumentError
from flockana.interactions import Gains
from flockana.plots import control_plots as draw
from flockana.stability.centre_transfer import CentreOfMass
from flockana.stability.gain_sweeps import MarginSweep, Sweep, centre_locus
from flockana.stability.law_studies import NormTable
from tests.plots.artists import axes


def lines(ax):
    return {line.get_label(): np.asarray(line.get_xydata()) for line in ax.get_lines()}


def test_bode_in_decibels_and_degrees():
    own, omega = Gains(c1_gamma=4.0, c2_gamma=4.0), np.array([1.0, 2.0, 4.0])
    responses = {f"{f:g}": CentreOfMass(own, f).frequency_response(omega) for f in (0.0, 1.0)}
    top, bottom = draw.bode(responses, marks={"case 4": 2.0}, ax=Figure().subplots(2, 1))
    hidden = lines(top)["0"]
    np.testing.assert_allclose(hidden[:, 0], omega)
    np.testing.assert_allclose(hidden[1, 1], 20 * np.log10(0.5))  # 4/(8j)
    phases = bottom.get_lines()[0].get_ydata()
    np.testing.assert_allclose(phases[1], -90.0)
    assert (top.get_ylabel(), bottom.get_xlabel()) == ("$|q_c/q_r|$ (dB)", r"$\omega$ (radians/time)")
    assert [t.get_text() for t in top.texts] == ["case 4"]
    assert [t.get_text() for t in top.get_legend().get_texts()] == ["0", "1"]


def test_bode_draws_all_that_it_is_given():
    """A system with two outputs is two curves, named by their signals; six responses are six curves."""
    omega = np.array([0.5, 1.0, 2.0])
    swing = control.ss([[0.0, 1.0], [-4.0, -1.0]], [[0.0], [1.0]], np.eye(2), 0, inputs=["f0_x"], outputs=["x0_x", "v"])
    top, _ = draw.bode({"swing": control.frequency_response(swing, omega)}, ax=Figure().subplots(2, 1))
    assert [t.get_text() for t in top.get_legend().get_texts()] == ["swing: x0_x/f0_x", "swing: v/f0_x"]
    np.testing.assert_allclose(lines(top)["swing: v/f0_x"][1, 1], 20.0 * np.log10(abs(1j / (3.0 + 1j))))
    assert top.get_ylabel() == "magnitude (dB)"
    one = control.frd([1.0, 2.0, 3.0], omega, inputs=["f0_x"], outputs=["l0_1"])
    top, _ = draw.bode({"one": one}, ax=Figure().subplots(2, 1))
    assert "l0_1/f0_x" in top.get_ylabel()
    top, _ = draw.bode({str(k): one for k in range(6)}, ax=Figure().subplots(2, 1))
    drawn = [line for line in top.get_lines() if line.get_label() in "012345"]
    assert len({(line.get_color(), line.get_linestyle()) for line in drawn}) == 6


def test_nyquist_draws_both_branches_about_minus_one():
    """L = 2/(s + 1): at ω = 1 it is 1 − j."""
    loop = control.tf([2.0], [1.0, 1.0])
    ax = draw.nyquist({"L": control.frequency_response(loop, [0.0, 1.0, 10.0])}, ax=axes())
    forward, mirrored = ax.get_lines()[:2]
    np.testing.assert_allclose([forward.get_xdata()[1], forward.get_ydata()[1]], [1.0, -1.0])
    np.testing.assert_allclose(mirrored.get_ydata(), -forward.get_ydata())
    np.testing.assert_allclose(lines(ax)["−1"], [[-1.0, 0.0]])


def test_singular_values_are_those_of_the_response():
    omega = np.array([1.0, 2.0])
    values = np.array([[[3.0, 3.0], [0.0, 0.0]], [[0.0, 0.0], [4.0, 5.0]]])
    ax = draw.singular_values(control.frd(values, omega), ax=axes())
    np.testing.assert_allclose(lines(ax)["largest"][:, 1], 20.0 * np.log10([4.0, 5.0]))


def test_the_root_locus_starts_at_crosses_and_ends_at_dots():
    sweep, _ = centre_locus(Gains(c2_gamma=2.0), "c1_gamma", [0.0, 1.0, 2.0])
    ax = draw.root_locus(sweep, ax=axes())
    found = lines(ax)
    np.testing.assert_allclose(found["c1γ = 0"], [[-2.0, 0.0], [0.0, 0.0]], atol=1e-12)
    np.testing.assert_allclose(np.sort(found["c1γ = 2"], axis=0), [[-1.0, -1.0], [-1.0, 1.0]], atol=1e-12)
    assert ax.get_xlabel() == "Re $s$ (1/time)"


def test_the_gain_sweep_leaves_the_neutral_out():
    sweep = Sweep("c2_alpha", np.array([1.0, 2.0]), np.array([[0.0, -1.0 + 2j, -3.0], [0.0, -2.0 + 1j, -4.0]]), 1)
    ax = draw.gain_sweep(sweep, ax=axes())
    np.testing.assert_allclose(lines(ax)["the slowest"][:, 1], [-1.0, -2.0])
    assert "(1 neutral not shown)" in lines(ax)
    assert ax.get_xlabel() == r"$c_2^\alpha$ (1/time)"
    assert sum(np.array_equal(line.get_ydata(), [-3.0, -4.0]) for line in ax.get_lines()) == 1


def test_norms_and_their_bounds():
    table = NormTable(
        (3, 7), np.array([1.0, 2.0]), np.array([0.5, 0.7]), np.ones(2), np.array([[0.8, 1.2], [1.5, 3.0]])
    )
    ax = draw.norms(table, ax=axes())
    np.testing.assert_allclose(lines(ax)["H₂ (time^(3/2))"], [[3, 1.0], [7, 2.0]])
    np.testing.assert_allclose(lines(ax)["H∞ (time²)"][:, 1], [0.5, 0.7])
    band = ax.collections[0].get_paths()[0].vertices
    assert (band[:, 1].min(), band[:, 1].max()) == (0.8, 3.0)
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")


def test_the_delay_chart_shades_what_is_stable():
    values = np.array([1.0, 2.0])
    sweeps = {"all": MarginSweep("c1_gamma", values, 0.2 / values, values, "all")}
    sweeps["pairs"] = MarginSweep("c1_gamma", values, np.array([0.3, 0.2]), values, "all")
    ax = draw.delay_chart(sweeps, ax=axes())
    np.testing.assert_allclose(lines(ax)["pairs"][:, 1], [0.3, 0.2])
    assert ax.collections[0].get_paths()[0].vertices[:, 1].max() == 0.2
    assert (ax.get_xlabel(), ax.get_ylim()[0]) == (r"$c_1^\gamma$ (1/time$^2$)", 0.0)


@pytest.mark.parametrize(
    ("responses", "message"),
    [(3, "responses = 3: expected a mapping"), ({"a": 3}, r"responses\['a'\] = 3: expected a frequency response")],
)
def test_a_bode_plot_is_of_responses(responses, message):
    with pytest.raises(ArgumentError, match=message):
        draw.bode(responses)
