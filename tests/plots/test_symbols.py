"""Symbols are typeset wherever a label, a legend or a colour bar shows them; words stay words."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser

from flockana.plots.style import colour_bar, finish
from flockana.plots.symbols import typeset


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("c1γ/c1α", r"$c_1^\gamma$/$c_1^\alpha$"),
        ("H − H(0) − ∫ dH/dt", r"$H - H(0) - \int \dot H\,dt$"),
        ("H₂ (time^(3/2))", "$H_2$ (time$^{3/2}$)"),
        ("φ_α, the pair's action", r"$\phi_\alpha$, the pair's action"),
        ("γ-agent's ‖p_r‖", r"$\gamma$-agent's $\Vert p_r\Vert$"),
        ("|q_c/q_r| (dB)", "$|q_c/q_r|$ (dB)"),
        ("p_r = 0.009 dq_r/dt", r"$p_r$ = 0.009 $\dot q_r$"),
        ("K\u0303, velocity mismatch (length²/time²)", r"$\tilde K$, velocity mismatch (length$^2$/time$^2$)"),
        ("H\u0304, every pair", r"$\bar H$, every pair"),
        ("c* = 52.4", "$c^*$ = 52.4"),
        ("breathing: s = −3, ζ = 0.6", r"breathing: $s$ = −3, $\zeta$ = 0.6"),
        ("C = rank(L)/(n − 1)", r"$C = \mathrm{rank}(L)/(n - 1)$"),
        ("least V", "least $V$"),
        ("a (4 runs)", "a (4 runs)"),
        ("a run", "a run"),
        ("a", "$a$"),
        ("c", "$c$"),
        ("c1_alpha", "c1_alpha"),
        ("min_distance", "min_distance"),
        ("already $x_i$, γ", "already $x_i$, γ"),
    ],
)
def test_symbols_and_words(text, expected):
    assert typeset(text) == expected
    MathTextParser("agg").parse(typeset(text))  # what matplotlib cannot read would fail when it is drawn


def test_axes_legends_and_colour_bars_are_typeset():
    figure = Figure()
    ax = figure.add_subplot()
    ax.plot([0, 1], [0, 1], label="γ-agent")
    finish(ax, "t (time)", "‖u‖ (length/time²)")
    bar = colour_bar(ax, ax.scatter([0, 1], [0, 1], c=np.arange(2.0)), "c1γ")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$t$ (time)", r"$\Vert u\Vert$ (length/time$^2$)")
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [r"$\gamma$-agent"]
    assert ax.lines[0].get_label() == "γ-agent"  # as it was given
    assert bar.ax.get_ylabel() == r"$c_1^\gamma$"
