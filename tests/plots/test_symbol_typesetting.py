import pytest
from matplotlib.mathtext import MathTextParser

from flockana.plots.symbol_typesetting import typeset


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("c1γ/c1α", r"$c_1^\gamma$/$c_1^\alpha$"),
        ("H − H(0) − ∫ dH/dt", r"$H - H(0) - \int \dot H\,dt$"),
        ("φ_α, the pair's action", r"$\phi_\alpha$, the pair's action"),
        ("|q_c/q_r| (dB)", "$|q_c/q_r|$ (dB)"),
        ("p_r = 0.009 dq_r/dt", r"$p_r$ = 0.009 $\dot q_r$"),
        ("K\u0303, velocity mismatch (length²/time²)", r"$\tilde K$, velocity mismatch (length$^2$/time$^2$)"),
        ("H\u0304, every pair", r"$\bar H$, every pair"),
        ("c* = 52.4", "$c^*$ = 52.4"),
        ("breathing: s = −3, ζ = 0.6", r"breathing: $s$ = −3, $\zeta$ = 0.6"),
        ("C = rank(L)/(n − 1)", r"$C = \mathrm{rank}(L)/(n - 1)$"),
        ("least V", "least $V$"),
        ("a (4 runs)", "a (4 runs)"),
        ("a", "$a$"),
        ("c1_alpha", "c1_alpha"),
        ("qc_x/f0_x", "qc_x/f0_x"),
        ("already $x_i$, γ", "already $x_i$, γ"),
    ],
)
def test_symbols_and_words(text, expected):
    assert typeset(text) == expected
    MathTextParser("agg").parse(typeset(text))  # what matplotlib cannot read would fail when it is drawn
