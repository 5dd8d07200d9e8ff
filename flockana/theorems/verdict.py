"""Hypotheses, claims and verdicts, and how a verdict follows from its claims."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal

from flockana.base.errors import ArgumentError
from flockana.theorems.headline import BYLINES, does_not_hold, headline, merged, overall, plain
from flockana.theorems.tolerances import Tolerances as Tolerances
from flockana.theorems.written import verdict_html, verdict_latex

Status = Literal["verified", "refuted", "vacuous", "inconclusive"]
Rigour = Literal["symbolic", "smt", "interval", "numeric", "statistical"]
HypothesisStatus = Literal["met", "unmet", "assumed"]
Decided = Literal["exact", "proved", "enclosed", "assumed"]  # surest first
About = Literal["run", "limit", "all"]
By = Literal["source", "corrected", "flockana"]  # whose statement it is

Needs = Iterable["Hypothesis"]  # hypotheses under which something is claimed
_DECIDED: tuple[Decided, ...] = ("exact", "proved", "enclosed", "assumed")
_RIGOURS: tuple[Rigour, ...] = ("statistical", "numeric", "interval", "smt", "symbolic")  # weakest first


@dataclass(frozen=True)
class Hypothesis:
    """A condition of a theorem, and whether it holds in one case.

    Parameters
    ----------
    status : {"met", "unmet", "assumed"}
        ``"assumed"`` where it quantifies over more than one run can show.
    margin : float, optional
        How far it is met (positive) or missed (negative).
    detail : str
        In words.
    error : float, optional
        Numerical error of the margin, where it has one.
    decided : {"exact", "proved", "enclosed", "assumed"}
        By which means: from parameters or a closed form; by a proof; by an enclosure of this run, recording or tube; or
        not at all, as its user states it or nobody knows. What has the status ``"assumed"`` is always the last.
    """

    name: str
    status: HypothesisStatus
    margin: float | None = None
    detail: str = ""
    error: float | None = None
    decided: Decided = "exact"

    def __post_init__(self) -> None:
        if self.status == "assumed":
            object.__setattr__(self, "decided", "assumed")


@dataclass(frozen=True)
class Claim:
    """One statement of a theorem about one case, with its status, margin and numerical error.

    Parameters
    ----------
    name : str
        Short name, such as ``"iii"``.
    status : {"verified", "refuted", "vacuous", "inconclusive"}
        Whether it holds.
    rigour : {"symbolic", "smt", "interval", "numeric", "statistical"}
        How it is known; "statistical" of a recording whose noise is stated.
    computed, stated : object
        What was computed here, and what the theorem states.
    margin : float, optional
        How far the claim holds (positive) or fails (negative).
    error : float, optional
        How far the margin may be off towards 0 and beyond; a margin of a smaller size is inconclusive.
    witness : object
        What shows it: a time, a pair of agents, an eigenvalue, an expression.
    proof, disproof : str, optional
        Identifier of an executable proof of exactly this claim, or of its negation, under its needs.
    detail : str
        The statement and the evidence, in one sentence.
    needs : tuple of Hypothesis
        Hypotheses under which it is claimed.
    about : {"run", "limit", "all"}
        What it speaks of: this run, a limit t → ∞, or all cases at once.
    cites : tuple of str
        Lemmas of analysis that the deciding proof takes from the literature.
    contradicts : str
        Identifier of the proof that the decided numbers contradict; the run or the library is at fault then.
    by : {"source", "corrected", "flockana"}
        Whose claim it is: the source's, as printed; a correction of it; or the library's own.

    Raises
    ------
    ArgumentError
        On an error below 0, and on a status that the needs do not allow: decided under an unmet one; refuted, or
        verified of a limit or of all cases, under one that is only assumed.
    """

    name: str
    status: Status
    rigour: Rigour = "numeric"
    computed: Any = None
    stated: Any = None
    margin: float | None = None
    error: float | None = None
    witness: Any = None
    proof: str | None = None
    detail: str = ""
    disproof: str | None = None
    needs: tuple[Hypothesis, ...] = ()
    about: About = "run"
    contradicts: str = ""
    cites: tuple[str, ...] = ()
    by: By = "source"

    def __post_init__(self) -> None:
        if self.error is not None and self.error < 0.0:
            raise ArgumentError(f"claim {self.name!r} has error = {self.error:g}: expected none below 0")
        if self.status not in ("verified", "refuted"):
            return
        weak = self.status == "refuted" or self.about != "run"
        barred = {"unmet", "assumed"} if weak else {"unmet"}
        if (need := next((need for need in self.needs if need.status in barred), None)) is not None:
            raise ArgumentError(
                f"claim {self.name!r} is {self.status} though {need.name!r} is {need.status}: expected vacuous or "
                "inconclusive"
            )

    def described(self, *, detail: str = "", **fields: Any) -> "Claim":
        """Return the claim with words and numbers added to what was decided.

        Parameters
        ----------
        detail : str
            Put before the detail that the claim has.
        **fields
            `computed`, `stated` and `witness`.

        Examples
        --------
        >>> Claim("i", "verified", detail="proved").described(stated="1 + 1 = 2", detail="by algebra").detail
        'by algebra; proved'
        """
        return replace(self, detail="; ".join(filter(None, (detail, self.detail))), **fields)

    @property
    def explanation(self) -> str:
        """Detail; for a vacuous claim with the unmet hypothesis in front."""
        missed = unmet(self.needs) if self.status == "vacuous" else None
        if missed is None or self.detail.startswith(does_not_hold(missed.name)):
            return self.detail
        return f"{does_not_hold(missed.name)}; {self.detail}"

    @property
    def cited(self) -> str:
        """Results of the literature that the claim's proof cites, in words, or an empty text."""
        return f" [proof cites {', '.join(self.cites)}]" if self.cites else ""


@dataclass(frozen=True)
class Verdict:
    """The outcome of checking a theorem on a case.

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
    """

    theorem: str
    hypotheses: tuple[Hypothesis, ...]
    claims: tuple[Claim, ...]
    tolerances: Tolerances = field(default_factory=Tolerances)
    subject: str = ""
    author: By = "source"

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
        """Of the author's claims: refuted if one is; else inconclusive if one is; else verified; else vacuous."""
        return overall(claim.status for claim in self.main_claims)

    @property
    def summary(self) -> str:
        """The status with counts, and apart from it the corrections and extensions.

        Examples
        --------
        >>> claims = Claim("i", "vacuous"), Claim("cross", "verified", stated="no two links cross", by="flockana")
        >>> Verdict("os-5", (Hypothesis("κ > 1", "unmet"),), claims).summary
        '1 of 1 vacuous: κ > 1 does not hold; our extension: no two links cross, verified'
        """
        return headline(self)

    @property
    def contradictions(self) -> tuple[Claim, ...]:
        """Claims whose decided numbers contradict a proof."""
        return tuple(claim for claim in self.claims if claim.contradicts)

    @property
    def rigour(self) -> Rigour:
        """The weakest rigour among the claims that decide the status."""
        deciding = [c.rigour for c in self.main_claims if c.status == self.status] or ["numeric"]
        return min(deciding, key=_RIGOURS.index)

    def claim(self, name: str) -> Claim:
        """The claim of that name.

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
        """Plain data for JSON; infinities and NaN become text."""
        data: dict[str, Any] = plain(asdict(self))
        for claim in data["claims"]:
            claim["needs"] = [need["name"] for need in claim["needs"]]
        head = {"theorem": data.pop("theorem"), "status": self.status, "summary": self.summary, "rigour": self.rigour}
        return head | data

    def __str__(self) -> str:
        lines = [f"{self.theorem}: {self.status} ({self.rigour}){' on ' + self.subject if self.subject else ''}"]
        lines += [f"  {self.summary}"]
        lines += [f"  given {h.status:8} {h.name}{': ' + h.detail if h.detail else ''}" for h in self.hypotheses]
        for name, c in merged((*self.main_claims, *self.further_claims)):
            whose = "" if c.by == self.author else f"[{BYLINES[c.by]}] "
            lines.append(f"  {name:>14} {c.status:12} {whose}{c.explanation}{c.cited}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        return verdict_html(self)

    def to_latex(self) -> str:
        """Return the claims as a LaTeX ``tabular`` in the style of booktabs."""
        return verdict_latex(self)


def unmet(hypotheses: Needs) -> Hypothesis | None:
    """Return the first unmet hypothesis; None if no hypothesis is unmet.

    Parameters
    ----------
    hypotheses : iterable of Hypothesis
        In the theorem's order.

    Examples
    --------
    >>> unmet([Hypothesis("c1α > 0", "met"), Hypothesis("c2α > 0", "unmet")]).name
    'c2α > 0'
    """
    return next((hypothesis for hypothesis in hypotheses if hypothesis.status == "unmet"), None)


def with_alarm(claims: Iterable[Claim]) -> tuple[Claim, ...]:
    """Return claims; where numbers contradict a proof, none that has hypotheses is decided.

    Parameters
    ----------
    claims : iterable of Claim
        Of one verdict.

    Examples
    --------
    >>> gain = Hypothesis("c1α > 0", "met")
    >>> wrong = Claim("i", "inconclusive", needs=(gain,), contradicts="cohesion")
    >>> [claim.status for claim in with_alarm([wrong, Claim("iii", "verified", needs=(gain,))])]
    ['inconclusive', 'inconclusive']
    """
    claims = tuple(claims)
    alarm = next((claim for claim in claims if claim.contradicts), None)
    if alarm is None:
        return claims
    doubt = max(alarm.needs, key=lambda need: _DECIDED.index(need.decided), default=None)
    which = f": doubt first that {doubt.name} ({doubt.decided})" if doubt else ""
    text = f"nothing is decided, as the numbers of {alarm.name} contradict the proof {alarm.contradicts!r}{which}"

    def judged(claim: Claim) -> Claim:
        if not (claim is alarm or (claim.needs and claim.status in ("verified", "refuted"))):
            return claim
        return replace(claim, status="inconclusive", detail=f"{claim.detail}; {text}".lstrip("; "))

    return tuple(map(judged, claims))
