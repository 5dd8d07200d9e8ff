"""Typesetting of symbols in labels, legends and titles as mathtext."""

import re
from collections.abc import Callable

_GREEK = dict(
    zip(
        "αβγδεζηθκλ",
        ["alpha", "beta", "gamma", "delta", "varepsilon", "zeta", "eta", "theta", "kappa", "lambda"],
        strict=True,
    )
)
_GREEK |= dict(zip("μνξπρστφψω", ["mu", "nu", "xi", "pi", "rho", "sigma", "tau", "phi", "psi", "omega"], strict=True))
_LETTERS = "".join(_GREEK)
_DIGITS = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
_WORDS = {"time²": "time$^2$", "length²": "length$^2$", "time^(3/2)": "time$^{3/2}$", "H∞": r"$H_\infty$"}


def _greek(letter: str) -> str:
    return "\\" + _GREEK[letter] if letter in _GREEK else letter


# each pattern is tried at a place before those below it; a letter alone is a symbol where a label begins with it
_RULES: tuple[tuple[str, Callable[[re.Match[str]], str]], ...] = (
    ("|".join(re.escape(word) for word in _WORDS), lambda m: _WORDS[m[0]]),
    (r"H − H\(0\) − ∫ dH/dt", lambda m: r"$H - H(0) - \int \dot H\,dt$"),
    (r"d([qp])_([a-z])/dt", lambda m: rf"$\dot {m[1]}_{m[2]}$"),
    (r"C = rank\(L\)/\(n − 1\)", lambda m: r"$C = \mathrm{rank}(L)/(n - 1)$"),
    (rf"c([12])([{_LETTERS}])", lambda m: rf"$c_{m[1]}^{_greek(m[2])}$"),
    (r"\|([qp])_([a-z])/([qp])_([a-z])\|", lambda m: rf"$|{m[1]}_{m[2]}/{m[3]}_{m[4]}|$"),
    (r"‖([a-z])(?:_([a-z]))?‖", lambda m: rf"$\Vert {m[1]}{f'_{m[2]}' if m[2] else ''}\Vert$"),
    (
        rf"(?<![A-Za-z0-9])([{_LETTERS}A-Za-z])_([{_LETTERS}a-z])(?![A-Za-z_])",
        lambda m: rf"${_greek(m[1])}_{_greek(m[2])}$",
    ),
    (r"([A-Za-z])([₀-₉])", lambda m: f"${m[1]}_{m[2].translate(_DIGITS)}$"),
    (rf"([{_LETTERS}c])\*", lambda m: f"${_greek(m[1])}^*$"),
    ("([A-Z])\u0303|(Ẽ)", lambda m: rf"$\tilde {m[1] or 'E'}$"),
    ("([A-Z])\u0304", lambda m: rf"$\bar {m[1]}$"),
    (r"\b(Re|Im) s\b", lambda m: f"{m[1]} $s$"),
    (f"[{_LETTERS}]", lambda m: f"${_greek(m[0])}$"),
    (r"\bd'(?!\w)", lambda m: "$d'$"),
    (r"(?<=least )V\b", lambda m: "$V$"),
    (r"\b([a-z])(?= = )", lambda m: f"${m[1]}$"),
    (r"^([B-HJ-Zb-z](?=,? [a-z(=]|$)|a$)", lambda m: f"${m[1]}$"),  # but no "I", nor "a" before others, which are words
)
_ANY = re.compile("|".join(f"(?P<r{k}>{pattern})" for k, (pattern, _) in enumerate(_RULES)))


def typeset(text: str) -> str:
    r"""Return a label with its symbols in mathtext; existing mathtext is kept."""
    if "$" in text:
        return text

    def rule(m: re.Match[str]) -> str:
        pattern, write = _RULES[int(str(m.lastgroup)[1:])]
        match = re.compile(pattern).match(text, m.start())
        assert match is not None
        return write(match)

    return _ANY.sub(rule, text)
