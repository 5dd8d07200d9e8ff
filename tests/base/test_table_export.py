from pathlib import Path

import pytest

import flockana
from flockana.base.table_export import facts_html, facts_text, html_table, latex_table, tex, text_table


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


def test_tables_as_text_html_and_latex():
    assert tex("c1α > 5% of ψ_α") == r"c1$\alpha$ $>$ 5\% of $\psi$\_$\alpha$"
    assert html_table([["i", "verified"]], ["claim", "status"])[:24] == "<table><thead><tr><th sc"
    rows = [["os-3", "verified"], ["energy", "refuted"]]
    assert text_table(rows, ["theorem", "status"]).split() == ["theorem", "status", *rows[0], *rows[1]]
    lines = latex_table([["i", "verified"]], ["claim", "status"], "ll").splitlines()
    assert lines[0] == r"\begin{tabular}{ll}"
    assert lines[2] == r"claim & status \\"
    assert lines[4] == r"i & verified \\"
    assert "<td" in facts_html("run", {"agents": 7})
    assert facts_text("run", {"agents": 7, "m": 2}) == "run\n  agents  7\n  m       2"
