"""Verdicts as HTML for a notebook and as LaTeX for a paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flockana.base.tables import MARKS, html_table, latex_table, number, tex
from flockana.theorems.headline import BYLINES

if TYPE_CHECKING:
    from flockana.theorems.theorem import Claim, Verdict


def verdict_html(verdict: Verdict) -> str:
    """Return a verdict as an HTML table of its hypotheses and claims."""
    rows: list[tuple[str, ...]] = [(f"given: {h.name}", h.status, "", h.detail) for h in verdict.hypotheses]
    rows += [(_named(verdict, c), c.status, number(c.margin), c.explanation + c.cited) for c in verdict.claims]
    on = f" on {verdict.subject}" if verdict.subject else ""
    caption = f"{verdict.theorem}: {MARKS[verdict.status]} {verdict.status} ({verdict.rigour}){on}; {verdict.summary}"
    return html_table(rows, ("claim", "status", "margin", "in words"), caption)


def verdict_latex(verdict: Verdict) -> str:
    """Return the claims of a verdict as a LaTeX ``tabular`` in the style of booktabs."""
    rows = [
        (tex(_named(verdict, c)), c.status, c.rigour, _measured(c.margin, c.error), tex(c.explanation + c.cited))
        for c in verdict.claims
    ]
    return latex_table(rows, ("claim", "status", "rigour", "margin", "in words"), "lllrp{0.45\\linewidth}")


def _named(verdict: Verdict, claim: Claim) -> str:
    """Return the name of a claim, and whose it is where it is not the author's."""
    return claim.name if claim.by == verdict.author else f"{claim.name} ({BYLINES[claim.by]})"


def _measured(margin: float | None, error: float | None) -> str:
    """Return a margin with its error as LaTeX mathematics."""
    if margin is None:
        return ""
    texts = [f"{value:.3g}" for value in (margin, error or 0.0)]
    plain = [f"{a} \\cdot 10^{{{int(b)}}}" if b else a for a, _, b in (text.partition("e") for text in texts)]
    return f"${plain[0]}$" if not error else f"${plain[0]} \\pm {plain[1]}$"
