"""Verdicts: results of checking theorems, from their claims, as text, HTML, LaTeX and data."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from flockana.base.table_export import MARKS, html_table, latex_table, number, tex
from flockana.theorems.claim import BYLINES, RIGOURS, By, Claim, Hypothesis, Rigour, Status
from flockana.theorems.tolerances import Tolerances
from flockana.theorems.verdict_summary import headline, merged, overall, plain

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Verdict:
    """Outcome of checking a theorem on a case.

    Parameters
    ----------
    theorem : str
        Its id.
    hypotheses, claims : tuple
        In the theorem's order.
    tolerances : Tolerances
        Thresholds that were used.
    subject : str
        What it was checked on.
    author : {"source", "corrected", "flockana"}
        Whose theorem it is: its claims alone decide the status.
    known_until : int, optional
        Of the run of a map, the last step at which its orbit is known, counted from the run's first sample.
    """

    theorem: str
    hypotheses: tuple[Hypothesis, ...]
    claims: tuple[Claim, ...]
    tolerances: Tolerances = field(default_factory=Tolerances)
    subject: str = ""
    author: By = "source"
    known_until: int | None = None

    @property
    def main_claims(self) -> tuple[Claim, ...]:
        """Claims of the theorem's author."""
        return tuple(claim for claim in self.claims if claim.by == self.author)

    @property
    def further_claims(self) -> tuple[Claim, ...]:
        """Corrections and extensions, which do not change the verdict's status."""
        return tuple(claim for claim in self.claims if claim.by != self.author)

    @property
    def status(self) -> Status:
        """Status of the author's claims: refuted, inconclusive, verified or vacuous, in this order."""
        return overall(claim.status for claim in self.main_claims)

    @property
    def summary(self) -> str:
        """Status with counts, and separately the corrections and extensions.

        Examples
        --------
        >>> claims = Claim("i", "vacuous"), Claim("cross", "verified", stated="no two links cross", by="flockana")
        >>> Verdict("os-5", (Hypothesis("κ > 1", "unmet"),), claims).summary
        '1 of 1 vacuous: κ > 1 does not hold; our extension: no two links cross, verified'
        """
        return headline(self.status, self.main_claims, self.further_claims, self.hypotheses)

    @property
    def contradictions(self) -> tuple[Claim, ...]:
        """Claims whose decided numbers contradict a proof."""
        return tuple(claim for claim in self.claims if claim.contradicts)

    @property
    def rigour(self) -> Rigour:
        """Weakest rigour among the claims that decide the status."""
        deciding_rigours = [c.rigour for c in self.main_claims if c.status == self.status] or ["numeric"]
        return min(deciding_rigours, key=RIGOURS.index)

    def claim(self, name: str) -> Claim:
        """Return the claim with a given name.

        Raises
        ------
        KeyError
            If there is none.
        """
        for claim in self.claims:
            if claim.name == name:
                return claim
        raise KeyError(f"{self.theorem} has no claim {name!r}; it has {', '.join(c.name for c in self.claims)}")

    def to_dict(self) -> dict[str, Any]:
        """Return the verdict as plain data for JSON; infinities and NaN become text."""
        data: dict[str, Any] = plain(asdict(self))
        for claim in data["claims"]:
            claim["needs"] = [requirement["name"] for requirement in claim["needs"]]
        head = {"theorem": data.pop("theorem"), "status": self.status, "summary": self.summary, "rigour": self.rigour}
        return head | data

    def __repr__(self) -> str:
        return f"<Verdict {self._head()}; {self.summary:.400}>"

    def _head(self) -> str:
        return f"{self.theorem}: {self.status} ({self.rigour}){' on ' + self.subject if self.subject else ''}"

    def __str__(self) -> str:
        lines = [self._head(), f"  {self.summary}"]
        lines += [f"  given {h.status:8} {h.name}{': ' + h.detail if h.detail else ''}" for h in self.hypotheses]
        for name, c in merged((*self.main_claims, *self.further_claims)):
            author_text = "" if c.by == self.author else f"[{BYLINES[c.by]}] "
            lines.append(f"  {name:>14} {c.status:12} {author_text}{c.explanation}{c.cited}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        rows: list[tuple[str, ...]] = [(f"given: {h.name}", h.status, "", h.detail) for h in self.hypotheses]
        rows += [(self._named(c), c.status, number(c.margin), c.explanation + c.cited) for c in self.claims]
        subject_text = f" on {self.subject}" if self.subject else ""
        caption = f"{self.theorem}: {MARKS[self.status]} {self.status} ({self.rigour}){subject_text}; {self.summary}"
        return html_table(rows, ("claim", "status", "margin", "in words"), caption)

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas table with a row for each claim, as `Verdicts.to_dataframe`."""
        return claim_table((self,))

    def to_latex(self) -> str:
        """Return the claims as a LaTeX ``tabular`` in the style of booktabs."""
        rows = [
            (tex(self._named(c)), c.status, c.rigour, _format_margin(c.margin, c.error), tex(c.explanation + c.cited))
            for c in self.claims
        ]
        return latex_table(rows, ("claim", "status", "rigour", "margin", "in words"), "lllrp{0.45\\linewidth}")

    def _named(self, claim: Claim) -> str:
        """Return the name of a claim, with its author if other than the theorem's."""
        return claim.name if claim.by == self.author else f"{claim.name} ({BYLINES[claim.by]})"


def claim_table(verdicts: Iterable[Verdict]) -> pandas.DataFrame:
    """Return a pandas table with a row for each claim of verdicts."""
    import pandas

    return pandas.DataFrame(
        [
            (v.theorem, c.name, c.status, c.rigour, c.by, c.margin, c.error, c.proof or c.disproof, c.explanation)
            for v in verdicts
            for c in v.claims
        ],
        columns=["theorem", "claim", "status", "rigour", "by", "margin", "error", "proof", "detail"],
    ).astype({"margin": float, "error": float})


def _format_margin(margin: float | None, error: float | None) -> str:
    """Return a margin with its error as LaTeX mathematics."""
    if margin is None:
        return ""
    texts = [f"{value:.3g}" for value in (margin, error or 0.0)]
    number_texts = [f"{a} \\cdot 10^{{{int(b)}}}" if b else a for a, _, b in (text.partition("e") for text in texts)]
    return f"${number_texts[0]}$" if not error else f"${number_texts[0]} \\pm {number_texts[1]}$"
