from pathlib import Path

import pytest

import flockana
from flockana.base.tables import tex


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("K̃ <= 5 %", r"$\tilde{K}$ $<$= 5 \%"),
        ("λ² ≠ ½", r"$\lambda$$^{2}$ $\not{=}$ $\frac{1}{2}$"),
        ("φ̄, ρ_i, Ω, ε, ς", r"$\bar{\varphi}$, $\rho$\_i, $\Omega$, $\varepsilon$, $\sigma$"),
        ("x₁ ∈ [−1, ∞)", r"x$_{1}$ $\in$ [$-$1, $\infty$)"),
        ("Łojasiewicz, Reynolds’", r"\L{}ojasiewicz, Reynolds’"),
    ],
)
def test_text_as_latex(text, latex):
    assert tex(text) == latex


def test_every_sign_in_a_verdict_has_its_latex():
    files = [*(Path(flockana.__file__).parent / "theorems").rglob("*.py")]
    signs = {sign for file in files for sign in file.read_text(encoding="utf-8") if not sign.isascii()}
    assert len(signs) > 40
    assert [sign for sign in signs if not tex(f"x{sign}").isascii()] == []
