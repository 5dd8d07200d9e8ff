"""Verdicts of several theorems on one case, as one table."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flockana.base.files import atomic_write
from flockana.base.table_export import MARKS, html_table, latex_table, tex, text_table
from flockana.theorems.catalogue import catalogue, theorem
from flockana.theorems.theorem import Verdict, unmet
from flockana.theorems.verdict import claim_table

if TYPE_CHECKING:
    import pandas

_HEADS = ("theorem", "status", "rigour", "decided by", "title")
_COLUMN = 28  # characters


class Verdicts(tuple[Verdict, ...]):
    """Verdicts on one run: a tuple printed as a table, in text and notebooks."""

    __slots__ = ()

    def rows(self) -> list[tuple[str, str, str, str, str]]:
        """Return (theorem, status, rigour, name of the deciding claim, title) of each verdict."""
        titles = {name: item.title for name, item in catalogue().items()}
        return [(v.theorem, v.status, v.rigour, _deciding(v), titles.get(v.theorem, "")) for v in self]

    def __str__(self) -> str:
        rows = [
            (v, f"{MARKS[status]} {status}", rigour, _cut(by), title) for v, status, rigour, by, title in self.rows()
        ]
        return text_table(rows, _HEADS)

    def __repr__(self) -> str:
        return f"<Verdicts on {len(self)} theorems: {', '.join(f'{v.theorem} {v.status}' for v in self)}>"

    def _repr_html_(self) -> str:
        return html_table(self.rows(), _HEADS)

    def about_the_law(self) -> Verdicts:
        """Return these verdicts without vacuous ones of theorems that name no law."""
        return Verdicts(v for v in self if v.status != "vacuous" or theorem(v.theorem).law is not None)

    def to_latex(self) -> str:
        """Return the table as a LaTeX ``tabular`` in the style of booktabs."""
        rows = [[tex(cell) for cell in row] for row in self.rows()]
        return latex_table(rows, _HEADS, "llllp{0.4\\linewidth}")

    def to_dict(self) -> list[dict[str, Any]]:
        """Return all verdicts as plain data for JSON."""
        return [verdict.to_dict() for verdict in self]

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas table with a row for each claim: status, evidence, author, numbers."""
        return claim_table(self)

    def to_mat(self, path: str | os.PathLike[str]) -> Path:
        """Write the table of claims as a MATLAB file with one struct, `claims`, and return its path."""
        from scipy.io import savemat

        table = self.to_dataframe()
        numeric_columns = {name: table[name].to_numpy(float) for name in ("margin", "error")}
        texts = {name: table[name].fillna("").to_numpy(object) for name in table if name not in numeric_columns}
        with atomic_write(path) as temporary_path:
            savemat(temporary_path, {"claims": texts | numeric_columns})
        return Path(path)


def _deciding(verdict: Verdict) -> str:
    """Return the name of the first claim with the verdict's status, or the unmet hypothesis of a vacuous one."""
    unmet_hypothesis = unmet(verdict.hypotheses) if verdict.status == "vacuous" else None
    if unmet_hypothesis is not None:
        return unmet_hypothesis.name
    return next((c.name for c in verdict.main_claims if c.status == verdict.status), "")


def _cut(text: str) -> str:
    """Return a text shortened to a column's width."""
    return text if len(text) <= _COLUMN else f"{text[: _COLUMN - 1]}…"
