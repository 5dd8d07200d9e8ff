"""Tables as HTML for a notebook and as LaTeX for a paper."""

import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from html import escape

MARKS = {"verified": "✓", "refuted": "✗", "vacuous": "∅", "inconclusive": "?", "met": "✓", "unmet": "✗", "assumed": "?"}
_TEX = {"\\": r"\textbackslash{}", **{c: "\\" + c for c in "&%$#_{}"}, "~": r"\textasciitilde{}", "^": r"\^{}"}
_NAMES = {"epsilon": "varepsilon", "phi": "varphi", "lamda": "lambda", "Lamda": "Lambda"}  # of TeX for Unicode's
_SIGNS = {
    **{"≤": "le", "≥": "ge", "≪": "ll", "±": "pm", "×": "times", "·": "cdot", "∘": "circ", "⊗": "otimes"},
    **{"∞": "infty", "→": "to", "‖": "Vert", "√": "surd", "∇": "nabla", "∂": "partial", "∫": "int", "∈": "in"},
    **{"⟨": "langle", "⟩": "rangle", "⌊": "lfloor", "⌋": "rfloor", "′": "prime", "…": "ldots", "ℓ": "ell"},
    "∅": "emptyset",
}
_WORDS = {"−": "$-$", "<": "$<$", ">": "$>$", "Ł": r"\L{}", "ł": r"\l{}", "✓": "yes", "✗": "no", "°": r"$^\circ$"}
_ACCENTS = {"\u0303": "tilde", "\u0304": "bar", "\u0302": "hat", "\u0338": "not"}
_ACUTE = "\u0301"


def tex(text: str) -> str:
    """Return text with LaTeX's own characters escaped and Greek letters as mathematics."""
    decomposed = unicodedata.normalize("NFD", text)
    return re.sub(
        f"(.)([{''.join(_ACCENTS)}{_ACUTE}]?)", lambda found: _letter(*found.groups()), decomposed, flags=re.DOTALL
    )


def _letter(letter: str, accent: str) -> str:
    """Return one letter of text, accented or not, as LaTeX."""
    if accent:
        return rf"\'{{{letter}}}" if accent == _ACUTE else rf"$\{_ACCENTS[accent]}{{{_letter(letter, '').strip('$')}}}$"
    if letter in _WORDS or letter in _TEX:
        return _WORDS.get(letter) or _TEX[letter]
    if letter in _SIGNS:
        return rf"$\{_SIGNS[letter]}$"
    kind, _, codes = unicodedata.decomposition(letter).partition(" ")
    parts = [chr(int(code, 16)) for code in codes.split()]
    if kind in ("<super>", "<sub>"):
        return f"${'^' if kind == '<super>' else '_'}{{{_letter(parts[0], '').strip('$')}}}$"
    if kind == "<compat>":  # such as three primes in one
        return "".join(_letter(symbol_part, "") for symbol_part in parts)
    if kind == "<fraction>":  # 1, a fraction slash, 2
        return rf"$\frac{{{parts[0]}}}{{{parts[2]}}}$"
    greek = re.fullmatch("GREEK (SMALL|CAPITAL) LETTER (?:FINAL )?([A-Z]+)", unicodedata.name(letter, ""))
    if greek:
        name = greek[2].lower() if greek[1] == "SMALL" else greek[2].capitalize()
        return rf"$\{_NAMES.get(name, name)}$"
    return letter


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
