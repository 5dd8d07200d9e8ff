"""Theorems: published statements, and verdicts on cases from their checks."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from flockana.theorems.claim import About as About
from flockana.theorems.claim import By as By
from flockana.theorems.claim import Claim as Claim
from flockana.theorems.claim import Decided as Decided
from flockana.theorems.claim import Hypothesis as Hypothesis
from flockana.theorems.claim import HypothesisStatus as HypothesisStatus
from flockana.theorems.claim import Needs as Needs
from flockana.theorems.claim import Rigour as Rigour
from flockana.theorems.claim import Status as Status
from flockana.theorems.claim import does_not_hold, with_alarm
from flockana.theorems.claim import unmet as unmet
from flockana.theorems.errata import Erratum, erratum_of
from flockana.theorems.tolerances import Tolerances as Tolerances
from flockana.theorems.verdict import Verdict as Verdict

Kind = Literal["trajectory", "configuration", "fixed"]
Known = tuple[tuple[Hypothesis, ...], tuple[Claim, ...]]  # what a theorem says of one case
Lead = Callable[[Any, Claim], float]
Checked = tuple[list[Hypothesis], list[Claim]]  # what a theorem's `check` returns
Check = Callable[..., tuple[Needs, Iterable[Claim]]]


@dataclass(frozen=True)
class Theorem:
    """Published statement, or its correction, with the function that checks it.

    Parameters
    ----------
    id : str
        Such as ``"os-1"``.
    statement : str
        What it says, in our words.
    source : str
        Where it is printed.
    kind : {"trajectory", "configuration", "fixed"}
        What `check` takes before the tolerances: a Trajectory; q, d, r; or nothing.
    check : callable
        Returns (hypotheses, claims); claims may be left out where a hypothesis is unmet (see `claims`).
    references : tuple of str
        Keys of the bibliography.
    expected : mapping of str to str
        For a fixed theorem, the status that is expected of it (key = its id) and of its claims (key = ``"id:claim"``).
    leads : mapping of str to callable
        By claim, a surrogate ``lead(trajectory, claim)`` in [0, 1] that leads a search for a counterexample where the
        claim's margin gives no slope.
    law : callable, optional
        Of a theorem about runs: ``law(run)`` is the hypothesis that the run is of a law that the theorem is about. Only
        if it is met is `check` called.
    claims : tuple of str
        Names of the claims, in order. Those that `check` leaves out are vacuous if a hypothesis is unmet.
    reason : str
        Text of such a vacuous claim, with ``{name}`` and ``{detail}`` of the first unmet hypothesis;
        ``{unmet}`` says that it does not hold.
    enclosed : callable, optional
        As `check`, of a tube (`flockana.enclose`), a certified basin that it may end in or None, and the tolerances.
    author : {"source", "corrected", "flockana"}
        Whose theorem it is; the claims are the author's unless named below.
    corrected, ours : tuple of str
        Names of the claims that correct the source, and of the library's own.
    on_motion : bool
        Whether it is about the motion as it is seen, or its end: then law and start decide none of its claims.
    wrapped : bool
        Whether it is about laws within disturbances, delays, clocks or limits too; else it is vacuous of their runs.
    """

    id: str
    title: str
    statement: str
    source: str
    kind: Kind
    check: Check
    references: tuple[str, ...] = ("olfati-saber-2006",)
    expected: Mapping[str, Status] = field(default_factory=dict)
    leads: Mapping[str, Lead] = field(default_factory=dict)
    law: Callable[[Any], Hypothesis] | None = None
    claims: tuple[str, ...] = ()
    reason: str = "{unmet}: {detail}"
    enclosed: Check | None = None
    author: By = "source"
    corrected: tuple[str, ...] = ()
    ours: tuple[str, ...] = ()
    on_motion: bool = False
    wrapped: bool = False

    def __repr__(self) -> str:
        return f"<Theorem {self.id!r}: {self.title}; {self.source}>"

    @property
    def erratum(self) -> Erratum | None:
        """Erratum checked by the theorem (printed and correct statement), or None."""
        return erratum_of(self.id)

    def by(self, claim: str) -> By:
        """Return the author of a named claim of the theorem."""
        return "corrected" if claim in self.corrected else "flockana" if claim in self.ours else self.author

    def verdict(self, known: Known, used: Tolerances, on: str) -> Verdict:
        """Return the verdict on a theorem, from its hypotheses and claims.

        Parameters
        ----------
        known : tuple
            Hypotheses and claims, as `examine` returns them.
        used : Tolerances
            Thresholds.
        on : str
            What it was checked on.
        """
        return Verdict(self.id, known[0], with_alarm(known[1]), used, on, self.author)

    def vacuous_claims(self, missed: Hypothesis) -> tuple[Claim, ...]:
        """Return all claims as vacuous under an unmet hypothesis.

        Parameters
        ----------
        missed : Hypothesis
            The unmet one.
        """
        text = f"{does_not_hold(missed.name)}: {missed.detail}".removesuffix(": ")
        return tuple(Claim(name, "vacuous", detail=text, needs=(missed,), by=self.by(name)) for name in self.claims)

    def hypotheses(self, start: Any) -> tuple[Hypothesis, ...]:
        """Return the hypotheses of the theorem and its claims at a start.

        Parameters
        ----------
        start : Observed
            A start as `flockana.theorems.applicability.start_of` returns it, or a run.

        Examples
        --------
        >>> import numpy as np
        >>> import flockana as fl
        >>> from flockana.theorems.applicability import start_of
        >>> start = start_of(fl.Algorithm1(), np.array([[0.0], [7.0]]), np.zeros((2, 1)), 0.0)
        >>> [need.name for need in fl.theorem("collision-energy").hypotheses(start)]
        ['Algorithm 1 or 2 is applied', 'c1α > 0', 'H(0) < c*', 'H(0) < 2 c*']
        """
        hypotheses, claims = self.examine(start, Tolerances())
        return tuple(dict.fromkeys((*hypotheses, *(requirement for claim in claims for requirement in claim.needs))))

    def examine(self, *case: Any, check: Check | None = None) -> Known:
        """Return hypotheses and claims of one case; claims left out by `check` are vacuous.

        Parameters
        ----------
        *case : object
            What `check` takes, the tolerances last.
        check : callable, optional
            Another check than the theorem's own, such as `enclosed`.
        """
        hypotheses = [] if self.law is None else [self.law(case[0])]
        claims: list[Claim] = []
        if unmet(hypotheses) is None:
            with np.errstate(over="ignore", invalid="ignore"):  # of runs that end beyond all numbers
                more_needs, new_claims = (check or self.check)(*case)
                hypotheses, claims = [*hypotheses, *more_needs], list(new_claims)
        if (missed := unmet(hypotheses)) is not None:
            words = {"name": missed.name, "detail": missed.detail, "unmet": does_not_hold(missed.name)}
            text, names = self.reason.format(**words).removesuffix(": "), {claim.name for claim in claims}
            missing_names = (name for name in self.claims if name not in names)
            claims += [Claim(name, "vacuous", detail=text, needs=(missed,)) for name in missing_names]
        owners = (self.by(claim.name) if claim.by == "source" else claim.by for claim in claims)
        return tuple(hypotheses), tuple(replace(claim, by=author) for claim, author in zip(claims, owners, strict=True))
