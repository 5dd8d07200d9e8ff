"""Hypotheses and claims: statements of a theorem about one case, and their evidence."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr

Status = Literal["verified", "refuted", "vacuous", "inconclusive"]
Rigour = Literal["symbolic", "smt", "interval", "numeric", "statistical"]
HypothesisStatus = Literal["met", "unmet", "assumed"]
Decided = Literal["exact", "proved", "enclosed", "assumed"]  # surest first
About = Literal["run", "limit", "all"]
By = Literal["source", "corrected", "flockana"]  # whose statement it is

Needs = Iterable["Hypothesis"]  # hypotheses under which something is claimed
_DECIDED: tuple[Decided, ...] = ("exact", "proved", "enclosed", "assumed")
RIGOURS: tuple[Rigour, ...] = ("statistical", "numeric", "interval", "smt", "symbolic")  # weakest first
# whose a claim is, in words
BYLINES: Mapping[str, str] = {"source": "the source's", "corrected": "corrected", "flockana": "our extension"}


@dataclass(frozen=True)
class Hypothesis(ShortRepr):
    """Condition of a theorem, and whether it holds in one case.

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
    on_motion : bool
        Whether it was looked for in the motion: then a start alone does not decide it.
    remedy : str
        What would meet it, in words; empty if nothing is known that would.
    """

    name: str
    status: HypothesisStatus
    margin: float | None = None
    detail: str = ""
    error: float | None = None
    decided: Decided = "exact"
    on_motion: bool = False
    remedy: str = ""

    def __post_init__(self) -> None:
        if self.status == "assumed":
            object.__setattr__(self, "decided", "assumed")


@dataclass(frozen=True)
class Claim(ShortRepr):
    """Statement of a theorem about one case, with its status, margin and numerical error.

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
        is_weak = self.status == "refuted" or self.about != "run"
        barred_statuses = {"unmet", "assumed"} if is_weak else {"unmet"}
        if (need := next((need for need in self.needs if need.status in barred_statuses), None)) is not None:
            raise ArgumentError(
                f"claim {self.name!r} is {self.status} though {need.name!r} is {need.status}: expected vacuous or "
                "inconclusive"
            )

    def described(self, *, detail: str = "", **fields: Any) -> "Claim":
        """Return the claim with added words and numbers.

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
        """Explanation of the claim: its detail, preceded by the unmet hypothesis if vacuous."""
        unmet_hypothesis = unmet(self.needs) if self.status == "vacuous" else None
        if unmet_hypothesis is None or self.detail.startswith(does_not_hold(unmet_hypothesis.name)):
            return self.detail
        return f"{does_not_hold(unmet_hypothesis.name)}; {self.detail}"

    @property
    def cited(self) -> str:
        """Literature cited by the claim's proof, in words, or an empty text."""
        return f" [proof cites {', '.join(self.cites)}]" if self.cites else ""


def unmet(hypotheses: Needs) -> Hypothesis | None:
    """Return the first unmet hypothesis; None if no hypothesis is unmet.

    Examples
    --------
    >>> unmet([Hypothesis("c1α > 0", "met"), Hypothesis("c2α > 0", "unmet")]).name
    'c2α > 0'
    """
    return next((hypothesis for hypothesis in hypotheses if hypothesis.status == "unmet"), None)


def with_alarm(claims: Iterable[Claim]) -> tuple[Claim, ...]:
    """Return claims; if numbers contradict a proof, no claim with hypotheses stays decided.

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
    alarm_text = f": doubt first that {doubt.name} ({doubt.decided})" if doubt else ""
    text = f"nothing is decided, as the numbers of {alarm.name} contradict the proof {alarm.contradicts!r}{alarm_text}"

    def judged(claim: Claim) -> Claim:
        if not (claim is alarm or (claim.needs and claim.status in ("verified", "refuted"))):
            return claim
        return replace(claim, status="inconclusive", detail=f"{claim.detail}; {text}".lstrip("; "))

    return tuple(map(judged, claims))


def does_not_hold(need: str) -> str:
    """Return a sentence that a hypothesis does not hold, with names in words quoted."""
    return f"{need if re.search('[<>=≤≥]', need) else repr(need)} does not hold"
