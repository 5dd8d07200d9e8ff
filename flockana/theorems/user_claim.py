"""User's own claim, from a function that measures its fulfilment on a run."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.theorems.observed_run import by_both_runs, with_hypothesis
from flockana.theorems.theorem import Theorem
from flockana.theorems.theorem_toolkit import Claim, Enclosure, Hypothesis, Observed, Tolerances, Trajectory, judged

BETWEEN = "the margin is not negative between samples"


def claim(name: str, margin: Callable[[Trajectory], Any], *, statement: str = "") -> Theorem:
    """Return a theorem with one claim: a margin is nonnegative at all samples of a run.

    The margin's numerical error is its difference between the run and a second, tighter one. What lies between the
    samples of a flow is assumed, and the verdict says so.

    Parameters
    ----------
    name : str
        Name of the claim, and id of the theorem.
    margin : callable
        ``margin(run)``: a number, or one for each sample (or for each sample and agent); at least 0 where the claim
        holds.
    statement : str
        The claim in words.

    Raises
    ------
    ArgumentError
        On a name that is no text or a margin that is no function; when it is checked, on a margin that is no number.

    Examples
    --------
    >>> from flockana import Algorithm1, verify
    >>> slow = claim("slow", lambda run: 10.0 - np.linalg.norm(run.p, axis=2).max(axis=1))
    >>> verify(slow, law=Algorithm1(), q0=[[0.0], [8.0]], t_span=(0, 1)).status
    'verified'
    """
    if not isinstance(name, str) or not name or not callable(margin):
        texts = f"{format_value(name)}, {format_value(margin)}"
        raise ArgumentError(f"claim({texts}): expected a name and a function of a run")
    text = statement or name
    return Theorem(name, text, text, "own claim", "trajectory", OwnCheck(name, margin, text), references=())


@dataclass(frozen=True)
class OwnCheck:
    """Check of a user's claim, sent to worker processes if its margin can be imported."""

    name: str
    margin: Callable[[Trajectory], Any]
    statement: str

    def __call__(self, seen: Observed, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
        """Return the user's claim, judged on a run and its repetition with tighter tolerances."""
        judged_claim = by_both_runs(seen, self.of_run)
        if seen.is_map or judged_claim.status != "verified":
            return [], [judged_claim]
        requirement = Hypothesis(BETWEEN, "assumed", detail=f"{len(seen.t)} samples are judged")
        return [requirement], [with_hypothesis(judged_claim, requirement)]

    def of_run(self, run: Trajectory) -> Claim:
        """Return the user's claim, judged by the least margin over one run."""
        margin = self.margin(run)
        try:
            margin_array = np.asarray(margin)
            values = np.atleast_1d(margin_array.astype(np.float64))
        except (TypeError, ValueError):
            values = margin_array = np.array([np.nan])
        if values.size == 0 or np.isnan(values).any() or margin_array.dtype == bool:
            value_text = "true or false" if margin_array.dtype == bool else format_value(margin)
            text = f"the margin of {self.name!r} is {value_text}: expected a number, or one for each sample"
            raise ArgumentError(f"{text}, that is at least 0 where the claim holds, such as limit - value")
        if len(values) == len(run.t):  # also one for each agent or pair: the least at each sample
            values = values.reshape(len(run.t), -1).min(axis=1)
        k = int(np.argmin(values))
        time_text = f"at t = {run.t[k]:.4g}, of {len(run.t)} samples" if values.size == len(run.t) else "of the run"
        detail = f"{self.statement}: margin {values.flat[k]:.4g} {time_text}"
        return judged(self.name, Enclosure.around(float(values.flat[k]), 0.0), detail=detail)
