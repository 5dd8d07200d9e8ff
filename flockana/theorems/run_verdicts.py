"""Verdicts on runs: the law matches the theorem's, and a second run encloses the error."""

from typing import Any

import numpy as np

from flockana.base.integrity_seals import ensure_sealed
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.wrapper_base import wrappers_of
from flockana.theorems.catalogue import catalogue
from flockana.theorems.evidence import Evidence
from flockana.theorems.fixed_step_verdicts import claims_on_steps, is_about_steps, on_steps
from flockana.theorems.observed_run import Observed, in_balls, with_resolution
from flockana.theorems.run_consistency import ensure_fits
from flockana.theorems.theorem import Hypothesis, Known, Theorem, Tolerances

_RUN = "a run as simulate returned it, or its window, its rescaled copy or its file"
_REMEDY = "simulate(law, q0, p0, t_span) makes one; samples from elsewhere are judged as Recording(t, q, p, bound=...)"


class RunEvidence(Evidence):
    """A run of a law or of a map."""

    def __init__(self, run: Trajectory) -> None:
        self.run, self.law, self.until = run, run.law, float(run.t[-1])

    def examine(self, item: Theorem, tolerances: Tolerances) -> Known:  # noqa: D102
        ensure_sealed("trajectory", self.run, _RUN, _REMEDY)
        if wrappers_of(self.law) and not (item.wrapped and self.law is self.law.continuous):
            return claims_on_another_law(item, self.law)
        ensure_fits(self.run)
        return examine_observed(item, Observed.of(self.run), tolerances)

    def known_until(self) -> int | None:  # noqa: D102
        return Observed.of(self.run).known_until if self.law.is_map else None

    def theorem_ids(self) -> tuple[str, ...]:  # noqa: D102
        return theorems_about(self.law, self.run.q[0], self.run.p[0], float(self.run.t[0]))


def examine_observed(item: Theorem, seen: Observed, tolerances: Tolerances) -> Known:
    """Return a theorem's result on an observed run, in fixed steps or along the flow."""
    if is_about_steps(item, seen):
        return with_resolution(*on_steps(item, seen, tolerances), seen)
    hypotheses, claims = with_resolution(*item.examine(seen, tolerances), seen)
    return hypotheses, tuple(in_balls(claim) for claim in claims) if seen.enclosed else claims


def claims_on_another_law(item: Theorem, law: Any) -> Known:
    """Return vacuous claims for a run of a wrapped law outside a theorem about the bare law."""
    wrapper_names = ", ".join(type(entry).__name__ for entry in wrappers_of(law))
    detail = f"the law of the run is wrapped in {wrapper_names}; the theorem is about the law alone"
    unmet_hypothesis = Hypothesis("the law acts undisturbed, at once and without a limit", "unmet", detail=detail)
    return (unmet_hypothesis,), item.vacuous_claims(unmet_hypothesis)


def theorems_about(law: Any, q0: Any, p0: Any, t0: float = 0.0) -> tuple[str, ...]:
    """Return the ids of theorems whose law hypothesis a law meets; errata are left out."""
    zero_velocities = np.zeros(np.shape(q0))
    observation = Observed.alone(Trajectory(np.array([t0]), np.array([q0]), np.array([p0]), zero_velocities[None], law))
    return tuple(name for name, item in catalogue().items() if name[0].islower() and _is_about(item, observation))


def _is_about(item: Theorem, seen: Observed) -> bool:
    if item.kind != "trajectory":
        return False
    return (
        item.law is None
        or item.law(seen).status != "unmet"
        or (item.id in claims_on_steps() and is_about_steps(item, seen))
    )
