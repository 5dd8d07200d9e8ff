"""Result of a search for a counterexample: the worst run, and every claim's margin over the search."""

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import ensure_sealed, sealed
from flockana.base.value_checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.falsify.counterexample import Counterexample
from flockana.scenarios import Scenario
from flockana.theorems import Verdict

Ending = Literal["found", "budget", "interrupted"]
_WORST_FIRST = ("refuted", "inconclusive", "verified", "vacuous", "failed")


@dataclass(frozen=True, eq=False)
class Falsification:
    """Result of a search for a counterexample by `falsify`: the worst run and all claims' margins.

    Parameters
    ----------
    theorem, claim : str
        What was searched, and the claim that came nearest to breaking.
    case : Scenario
        The scenario with the worst state and parameters that were found.
    parameters : mapping of str to float
        Those that were varied, with their worst values.
    verdict : Verdict or None
        On the worst run; None if every run failed.
    margins : mapping of str to ndarray, shape (evaluations,)
        Margin of each claim in each evaluation, the first on the scenario's own start; NaN where nothing is claimed.
    statuses : mapping of str to tuple of str
        Status of each claim in each evaluation, ``"failed"`` where the run failed.
    seed, budget, restarts : int
        Of the search.
    ended : {"found", "budget", "interrupted"}
        Why it ended.
    message : str
        Why runs failed, of the last that did.
    unmet : tuple of str
        Hypotheses that no run met: while there are any, nothing that was tried can refute the theorem.
    """

    theorem: str
    claim: str
    case: Scenario
    parameters: Mapping[str, float]
    verdict: Verdict | None
    margins: Mapping[str, FloatArray]
    statuses: Mapping[str, tuple[str, ...]]
    seed: int
    budget: int
    restarts: int
    ended: Ending
    message: str = ""
    unmet: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Return a summary of the search for a counterexample in one line."""
        what = f"{self.theorem}:{self.claim} on {self.scenario}"
        return f"<Falsification of {what}: {self.status}, margin {self.margin:.4g}, {self.evaluations} evaluations>"

    @property
    def scenario(self) -> str:
        """Name of the scenario in whose neighbourhood a counterexample was searched."""
        return self.case.name

    @property
    def q0(self) -> FloatArray:
        """Initial positions of the worst run of the search, shape (n, m)."""
        return self.case.q0

    @property
    def p0(self) -> FloatArray:
        """Initial velocities of the worst run of the search, shape (n, m)."""
        return self.case.p0

    def _worst(self, name: str, none: Any) -> Any:
        value = None if self.verdict is None else getattr(self.verdict.claim(self.claim), name)
        return none if value is None else value

    @property
    def margin(self) -> float:
        """Margin of the claim on the worst run; NaN without one."""
        return float(self._worst("margin", math.nan))

    @property
    def error(self) -> float:
        """Numerical error of the claim's margin on the worst run; NaN without a margin."""
        return float(self._worst("error", math.nan))

    @property
    def status(self) -> str:
        """Status of the claim on the worst run, ``"failed"`` if every run failed."""
        return str(self._worst("status", "failed"))

    @property
    def found(self) -> bool:
        """Whether a run refutes the claim by more than its numerical error."""
        return self.status == "refuted"

    @property
    def evaluations(self) -> int:
        """Number of runs that the search for a counterexample made."""
        return len(self.statuses[self.claim])

    @property
    def failures(self) -> int:
        """Number of runs of the search that failed."""
        return self.statuses[self.claim].count("failed")

    @property
    def history(self) -> FloatArray:
        """Least margin of the claim up to each evaluation, shape (evaluations,); NaN before the first margin."""
        return self.least(self.claim)

    def least(self, claim: str) -> FloatArray:
        """Return the least margin of a claim up to each evaluation, shape (evaluations,)."""
        return np.fmin.accumulate(self.margins[claim])

    def refuting(self, claim: str) -> tuple[int, ...]:
        """Return the evaluations that refute a claim, counted from 0."""
        return tuple(k for k, status in enumerate(self.statuses[claim]) if status == "refuted")

    @property
    def broken(self) -> tuple[str, ...]:
        """Claims refuted by some run of the search."""
        return tuple(name for name in self.statuses if self.refuting(name))

    def worst_status(self, claim: str) -> str:
        """Return the worst status of a claim in the search: refuted, else inconclusive, verified, vacuous, failed."""
        return min(self.statuses[claim], key=_WORST_FIRST.index)

    def run(self) -> Trajectory:
        """Simulate the worst case of the search again."""
        return self.case.run()

    def counterexample(self) -> Counterexample:
        """Return the worst case as a `Counterexample`.

        Raises
        ------
        ArgumentError
            If the claim did not break, or this is not as `falsify` returned it.
        """
        ensure_sealed("falsification", self, "one as falsify returned it", "search again with falsify(...)")
        if not self.found:
            raise ArgumentError(
                f"{self.theorem}:{self.claim} did not break (worst: {self.status}, margin {self.margin:.4g}): there is "
                "no counterexample; a larger budget, another seed or a wider region may find one, if there is any"
            )
        assert self.verdict is not None
        case, tolerances = self.case, self.verdict.tolerances
        start = case.law, case.q0, case.p0, case.t_span, case.options
        saved = Counterexample(self.theorem, self.claim, self.scenario, *start, tolerances, self.margin, self.error)
        return sealed(saved)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the counterexample as JSON, for `replay`.

        Raises
        ------
        ArgumentError
            If the claim did not break, or the law has no written form.
        FileError
            If it cannot be written.
        """
        return self.counterexample().save(path)
