"""The mathematics page: every formula printed from `flockana.symbolic`, so that it is what the code has."""

from __future__ import annotations

import csv

import sympy as sp

from tools.site.cache import ROOT
from tools.site.formulas import DERIVATIONS, FORMULAS
from tools.site.words import table

CODE = (
    ("$n$, $m$", "`n`, `m`"),
    ("$q_i$, $p_i$, $u_i$", "`q`, `p`, `u`: arrays of shape (n, m), of a run (T, n, m)"),
    ("$d$, $r$", "`d`, `r`"),
    (r"$\varepsilon$, $h$, $a$, $b$", "`eps`, `h`, `a`, `b`"),
    (r"$c_1^\alpha, c_2^\alpha$", "`c1_alpha`, `c2_alpha`"),
    (r"$c_1^\beta, c_2^\beta$", "`c1_beta`, `c2_beta`"),
    (r"$c_1^\gamma, c_2^\gamma$", "`c1_gamma`, `c2_gamma`"),
    ("$q_r$, $p_r$", "`target`"),
    ("$V$, $J$, $K$", "`energy`, `inertia`, `velocity_mismatch`"),
    ("$c^*$", "`c_star`"),
    (r"$\tilde E$, $\tilde K$", "`normalised_deviation_energy`, `normalised_velocity_mismatch`"),
    ("$C$, $R$", "`connectivity`, `cohesion_radius`"),
)
_OPENING = """\
# Mathematics

Nothing on this page but the notation is typed: each formula is printed by the function of `flockana.symbolic`
that stands beside it, and tests hold the compiled kernels against the same functions.
"""


def notation() -> str:
    """The table of notation, that of the lectures."""
    with (ROOT / "notebooks" / "notation.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file, delimiter="|")
    return table(header, rows)


def page() -> str:
    """The page as Markdown."""
    parts = [_OPENING, "## Notation", notation(), "### In the code", table(("symbol", "name"), CODE)]
    for title, formulas in FORMULAS.items():
        parts.append(f"## {title}")
        parts += [f"`{name}`:\n\n$$\n{left} = {sp.latex(make())}\n$$" for left, name, make in formulas]
    for title, derivations in DERIVATIONS.items():
        parts.append(f"## Derivations: {title[0].lower()}{title[1:]}")
        for name, make in derivations:
            derived = make()
            holds = (
                "every residual, computed, is 0" if derived.holds else "a residual, computed, is **not** 0: it is false"
            )
            parts += [f"### `{name}`", f"As computed: {holds}.", f"$$\n{derived.latex()}\n$$"]
    return "\n\n".join(parts) + "\n"
