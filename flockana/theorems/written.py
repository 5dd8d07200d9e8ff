"""Verdicts as HTML for a notebook, as LaTeX for a paper, and as lines of text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flockana.theorems.theorem import Verdict

MARKS = {"verified": "✓", "refuted": "✗", "vacuous": "∅", "inconclusive": "?", "met": "✓", "unmet": "✗", "assumed": "?"}
_TEX = {"\\": r"\textbackslash{}", **{c: "\\" + c for c in "&%$#_{}"}, "~": r"\textasciitilde{}", "^": r"\^{}"}
_GREEK = {"α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "varepsilon", "φ": "varphi", "ψ": "psi"}
_MORE = {"κ": "kappa", "λ": "lambda", "σ": "sigma", "π": "pi", "μ": "mu", "Σ": "Sigma", "≤": "le", "≥": "ge"}
_OTHER = {
    "∞": "infty",
    "→": "to",
    "‖": "Vert",
    "√": "surd",
    "∇": "nabla",
    "∈": "in",
    "·": "cdot",
    "−": "-",
    "Δ": "Delta",
}
_SUBSCRIPTS = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


def tex(text: str) -> str:
    """Return text with LaTeX's own characters escaped and Greek letters as mathematics.

    Examples
    --------
    >>> tex("c1α > 5% of ψ_α")
    'c1$\\\\alpha$ > 5\\\\% of $\\\\psi$\\\\_$\\\\alpha$'
    """
    commands = {**_GREEK, **_MORE, **_OTHER}
    return "".join(_letter(letter, commands) for letter in text)


def _letter(letter: str, commands: dict[str, str]) -> str:
    if letter in "<>":
        return f"${letter}$" if letter == "<" else letter
    if letter in commands:
        return "$-$" if letter == "−" else f"$\\{commands[letter]}$"
    if (digit := letter.translate(_SUBSCRIPTS)) != letter:
        return f"$_{digit}$"
    return _TEX.get(letter, letter)


def html_table(rows: Iterable[Sequence[str]], heads: Sequence[str], caption: str = "") -> str:
    """Return an HTML table; cells are escaped, and a status gets its mark.

    Examples
    --------
    >>> html_table([["i", "verified"]], ["claim", "status"])[:24]
    '<table><thead><tr><th sc'
    """
    head = "".join(f'<th scope="col" style="text-align:left">{escape(text)}</th>' for text in heads)
    body = "".join("<tr>" + "".join(map(_cell, row)) + "</tr>" for row in rows)
    title = f'<caption style="text-align:left">{escape(caption)}</caption>' if caption else ""
    return f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cell(text: str) -> str:
    mark = f"{MARKS[text]} " if text in MARKS else ""
    return f'<td style="text-align:left;vertical-align:top">{mark}{escape(text)}</td>'


def number(value: float | None) -> str:
    """Return a margin as text of four digits; empty for None.

    Examples
    --------
    >>> number(0.123456), number(None)
    ('0.1235', '')
    """
    return "" if value is None else f"{value:.4g}"


def verdict_html(verdict: Verdict) -> str:
    """Return a verdict as an HTML table of its hypotheses and claims."""
    rows: list[tuple[str, ...]] = [(f"given: {h.name}", h.status, "", h.detail) for h in verdict.hypotheses]
    rows += [(c.name, c.status, number(c.margin), c.detail + c.cited) for c in verdict.claims]
    on = f" on {verdict.subject}" if verdict.subject else ""
    caption = f"{verdict.theorem}: {MARKS[verdict.status]} {verdict.status} ({verdict.rigour}){on}"
    return html_table(rows, ("claim", "status", "margin", "in words"), caption)


def verdict_latex(verdict: Verdict) -> str:
    """Return the claims of a verdict as a LaTeX ``tabular`` in the style of booktabs."""
    rows = [
        (tex(c.name), c.status, c.rigour, _measured(c.margin, c.error), tex(c.detail + c.cited)) for c in verdict.claims
    ]
    return latex_table(rows, ("claim", "status", "rigour", "margin", "in words"), "lllrp{0.45\\linewidth}")


def latex_table(rows: Iterable[Sequence[str]], heads: Sequence[str], columns: str) -> str:
    """Return rows of LaTeX text as a ``tabular`` with the rules of booktabs.

    Examples
    --------
    >>> print(latex_table([["i", "verified"]], ["claim", "status"], "ll"))
    \\begin{tabular}{ll}
    \\toprule
    claim & status \\\\
    \\midrule
    i & verified \\\\
    \\bottomrule
    \\end{tabular}
    """
    lines = [" & ".join(row) + r" \\" for row in rows]
    top = [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", " & ".join(heads) + r" \\", r"\midrule"]
    return "\n".join([*top, *lines, r"\bottomrule", r"\end{tabular}"])


def _measured(margin: float | None, error: float | None) -> str:
    """Return a margin with its error as LaTeX mathematics."""
    if margin is None:
        return ""
    texts = [f"{value:.3g}" for value in (margin, error or 0.0)]
    plain = [f"{a} \\cdot 10^{{{int(b)}}}" if b else a for a, _, b in (text.partition("e") for text in texts)]
    return f"${plain[0]}$" if not error else f"${plain[0]} \\pm {plain[1]}$"
