"""Tables as HTML for a notebook and as LaTeX for a paper."""

import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from html import escape

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
    """Return text with LaTeX's own characters escaped and Greek letters as mathematics."""
    commands = {**_GREEK, **_MORE, **_OTHER}
    apart = unicodedata.normalize("NFD", text)
    pieces = re.split("(\\w\u0303)", apart)
    return "".join(
        rf"$\tilde{{{piece[0]}}}$" if piece[1:] == "\u0303" else "".join(_letter(one, commands) for one in piece)
        for piece in pieces
    )


def _letter(letter: str, commands: dict[str, str]) -> str:
    if letter in "<>":
        return f"${letter}$" if letter == "<" else letter
    if letter in commands:
        return "$-$" if letter == "−" else f"$\\{commands[letter]}$"
    if (digit := letter.translate(_SUBSCRIPTS)) != letter:
        return f"$_{digit}$"
    return _TEX.get(letter, letter)


def html_table(rows: Iterable[Sequence[str]], heads: Sequence[str], caption: str = "") -> str:
    """Return an HTML table; cells are escaped, and a status gets its mark."""
    head = "".join(f'<th scope="col" style="text-align:left">{escape(text)}</th>' for text in heads)
    body = "".join("<tr>" + "".join(map(_cell, row)) + "</tr>" for row in rows)
    title = f'<caption style="text-align:left">{escape(caption)}</caption>' if caption else ""
    return f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cell(text: str) -> str:
    mark = f"{MARKS[text]} " if text in MARKS else ""
    return f'<td style="text-align:left;vertical-align:top">{mark}{escape(text)}</td>'


def text_table(rows: Iterable[Sequence[str]], heads: Sequence[str]) -> str:
    """Return a table as lines of text with aligned columns."""
    padded = [[cell.ljust(max(map(len, column))) for cell in column] for column in zip(heads, *rows, strict=True)]
    return "\n".join("  ".join(row).rstrip() for row in zip(*padded, strict=True))


def number(value: float | None) -> str:
    """Return a margin as text of four digits; empty for None."""
    return "" if value is None else f"{value:.4g}"


def latex_table(rows: Iterable[Sequence[str]], heads: Sequence[str], columns: str) -> str:
    """Return rows of LaTeX text as a ``tabular`` with the rules of booktabs."""
    lines = [" & ".join(row) + r" \\" for row in rows]
    top = [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", " & ".join(heads) + r" \\", r"\midrule"]
    return "\n".join([*top, *lines, r"\bottomrule", r"\end{tabular}"])


def facts_html(title: str, facts: Mapping[str, object]) -> str:
    """Return an HTML table of names and values."""
    return html_table([(name, str(value)) for name, value in facts.items()], (title, ""))


def facts_text(title: str, facts: Mapping[str, object]) -> str:
    """Return lines of names and values under a title."""
    width = max(map(len, facts), default=0)
    return "\n".join([title, *(f"  {name.ljust(width)}  {value}" for name, value in facts.items())])
