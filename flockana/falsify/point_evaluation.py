"""Evaluation of a point of the search space: its run, verdict and grade."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from flockana.base.interrupts import restore_interrupts
from flockana.base.value_checks import FloatArray
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.trajectory import Trajectory
from flockana.falsify.bounded_space import Space
from flockana.falsify.claim_grade import FAILED, grade
from flockana.falsify.confirmation_run import confirmed
from flockana.scenarios import Scenario
from flockana.theorems import Claim, Theorem, Tolerances, Verdict, theorem, verify
from flockana.theorems.claims import vacuous
from flockana.theorems.search_objectives import squash
from flockana.theorems.theorem import Lead, unmet


@dataclass(frozen=True)
class Evaluation:
    """Grade, deciding claim and verdict of one point of the search space."""

    grade: float  # what the search minimises
    claim: str = ""  # the claim that decided it
    verdict: Verdict | None = None  # none if the run, or its check, failed
    message: str = ""  # why it failed

    @property
    def status(self) -> str:
        """Status of the claim that decided a point's grade, such as refuted or vacuous."""
        return "all failed" if self.verdict is None else self.verdict.claim(self.claim).status


@dataclass(frozen=True, eq=False)
class Problem:
    """Theorem to be refuted in a search space; called with a point it returns an `Evaluation`."""

    space: Space
    theorem: str | Theorem
    tolerances: Tolerances
    claim: str | None = None  # the claim whose grade counts; None for the least grade of all
    # ``surrogate(trajectory, claim) -> float`` in [0, 1], instead of the theorem's own `leads`
    surrogate: Lead | None = None
    scales: Mapping[str, float] = field(default_factory=dict)  # units of the margins by claim, 1 where none is given

    def __call__(self, point: FloatArray) -> Evaluation:
        """Evaluate a point of the search space; an error gives the grade of a failed run."""
        try:
            with restore_interrupts():
                run, verdict = self.judged(self.space.case(point))
                return self.graded(run, verdict)
        except Exception as error:  # a search must outlive every state that it tries
            return Evaluation(FAILED, message=f"{type(error).__name__}: {' '.join(str(error).split())}")

    @np.errstate(all="ignore")
    def judged(self, case: Scenario) -> tuple[Trajectory, Verdict | None]:
        """Return a case's run, and the verdict on a complete run, with refutations confirmed by a finer run."""

        def judge(again: Trajectory) -> Verdict:
            return verify(self.theorem, again, tolerances=self.tolerances, subject=case.name)

        run = ensure_uninterrupted(case.run())
        # of a part of a run no claim about the whole follows
        return run, confirmed(judge(run), judge, case) if run.status == "complete" else None

    @np.errstate(all="ignore")
    def graded(self, run: Trajectory, verdict: Verdict | None) -> Evaluation:
        """Return the evaluation of a run: its verdict, its worst claim, and that claim's grade for the search."""
        if verdict is None:
            return Evaluation(FAILED, message=run.message)
        if self.claim is not None and all(claim.name != self.claim for claim in verdict.claims):
            verdict = replace(verdict, claims=(*verdict.claims, vacuous(self.claim, "not judged")))
        claims = [claim for claim in verdict.claims if self.claim in (None, claim.name)]
        grades = {claim.name: self._grade(run, verdict, claim) for claim in claims}
        worst = min(grades, key=grades.__getitem__)
        return Evaluation(grades[worst], worst, verdict)

    def _grade(self, run: Trajectory, verdict: Verdict, claim: Claim) -> float:
        checked_theorem = self.theorem if isinstance(self.theorem, Theorem) else theorem(self.theorem)
        lead_objective = self.surrogate or checked_theorem.leads.get(claim.name)
        if claim.status == "vacuous" and unmet(verdict.hypotheses):
            lead_objective = None  # unmet hypotheses lead back; and the law may not have what a surrogate measures
        aid = None if lead_objective is None else min(max(float(lead_objective(run, claim)), 0.0), 1.0)
        value = grade(claim, verdict.hypotheses, scale=self.scales.get(claim.name, 1.0), lead=aid)
        if self.claim is None and claim.status == "inconclusive":
            return max(value, 0.0)  # its margin does not decide it, so a lower one must not draw the search
        return value


def units(verdict: Verdict) -> dict[str, float]:
    """Return the modulus of each claim's margin on a run as its unit, for comparing claims' margins."""
    magnitudes = {c.name: abs(float(c.margin)) for c in verdict.claims if c.margin is not None}
    return {name: unit_size for name, unit_size in magnitudes.items() if 0.0 < squash(unit_size) < 1.0}
