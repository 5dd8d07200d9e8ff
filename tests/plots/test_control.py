import numpy as np
import pytest
from matplotlib.figure import Figure

from flockana.base.errors import ArgumentError
from flockana.interactions import Gains
from flockana.plots import control as draw
from flockana.stability.norms import NormTable
from flockana.stability.sweeps import MarginSweep, Sweep, centre_locus
from flockana.stability.translational import CentreOfMass
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
