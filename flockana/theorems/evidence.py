"""Evidence for judging theorems, and the common interface of its kinds."""

from abc import ABC, abstractmethod
from dataclasses import replace
from typing import Any, ClassVar

from flockana.base.progress import progress_bar
from flockana.base.value_checks import FloatArray, ensure_points, ensure_positive
from flockana.theorems.catalogue import theorem
from flockana.theorems.theorem import Known, Theorem, Tolerances, Verdict
from flockana.theorems.verdicts import Verdicts


class Evidence(ABC):
    """Evidence for a theorem: a run, a map's run, a recording, a tube, a state, or nothing."""

    law: Any = None  # None if no law is known
    until: float | None = None  # up to when it shows motion, None where it shows none

    @abstractmethod
    def examine(self, item: Theorem, tolerances: Tolerances) -> Known:
        """Return hypotheses and claims of a theorem, from enclosures of observables; raise on an unsuitable case."""

    def describe(self, subject: str) -> str:
        """Return a description of the evidence for the verdict."""
        return subject

    def theorem_ids(self) -> tuple[str, ...]:
        """Return the ids of theorems judged by default."""
        return ()

    def known_until(self) -> int | None:
        """Return the last step with a known orbit of a map; None for other evidence."""
        return None

    def judge(self, item: Theorem, tolerances: Tolerances, subject: str = "") -> Verdict:
        """Return the verdict of a theorem."""
        verdict = item.verdict(self.examine(item, tolerances), tolerances, self.describe(subject))
        return replace(verdict, known_until=self.known_until())

    def judge_all(self, tolerances: Tolerances, subject: str = "", *, progress: bool = False) -> Verdicts:
        """Return the verdicts of all theorems about the law; without a law, of definitions about samples."""
        verdicts: list[Verdict] = []
        with progress_bar(len(names := self.theorem_ids()), enabled=progress) as advance:
            for name in names:
                advance(len(verdicts), name)
                verdicts.append(self.judge(theorem(name), tolerances, subject))
        return Verdicts(verdicts) if self.law is None else Verdicts(verdicts).about_the_law()


class NoCase(Evidence):
    """Empty evidence, for theorems decided without a case."""

    def examine(self, item: Theorem, tolerances: Tolerances) -> Known:  # noqa: D102
        return item.examine(tolerances)


class State(Evidence):
    """Positions of agents as evidence, with scale d and range r of their net."""

    def __init__(self, q: Any, d: Any, r: Any) -> None:
        self.q: FloatArray = ensure_points("q", q)
        self.d, self.r = ensure_positive("d", d), ensure_positive("r", r)

    def examine(self, item: Theorem, tolerances: Tolerances) -> Known:  # noqa: D102
        return item.examine(self.q, self.d, self.r, tolerances)


class NotEvidence:
    """Base class of objects mistaken for evidence: `advice` is the error message of `verify`."""

    advice: ClassVar[str]
