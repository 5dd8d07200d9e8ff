"""Run with its numerical error: enclosures of observables, from the run and a second run.

The second run starts alike and is a hundred times tighter, or looser where that cannot be. By how much the two differ,
doubled, encloses the state: each agent seen from the centre of mass, and the centre apart, at worst within one time
unit of the law before and after. No half width is below the solver's own floors. The start is exact. Of
a map the orbit is known as far as `flockana.theorems.map_steps` says. A run that failed, and one whose second run ends
early, encloses nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from flockana.base.natural_scales import Scales
from flockana.base.result_cache import ResultCache
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.error_tolerances import ErrorFloors
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.claims import with_needs
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.map_steps import paired_orbit
from flockana.theorems.rounding_bounds import EPS, energy_rounding, frame_error
from flockana.theorems.second_runs import DOUBT, Errors, centred, doubt_about, failure, largest_over, paired
from flockana.theorems.step_resolution import NAME
from flockana.theorems.theorem import Claim, Hypothesis, Known, Needs, Status


class End(NamedTuple):
    """Last state of a run in the frame of its centre of mass: positions and velocities with their errors."""

    q: FloatArray
    p: FloatArray
    q_error: FloatArray
    p_error: FloatArray

    @property
    def distance(self) -> float:
        """Largest distance of the computed last state from the true state, over all coordinates."""
        return float(np.linalg.norm(self.q_error))


@dataclass(frozen=True, eq=False)
class Observed(ResultCache):
    """Run paired with a second run from the same start, with enclosures of observables."""

    given: Trajectory  # The run that is judged
    run: Trajectory  # The tighter of the two, at the same samples: best values are its own
    other: Trajectory  # The looser of the two
    errors: Errors  # Half widths at the steps that both have in common
    doubt: str = ""  # Why nothing is known, or an empty text
    unresolved: str = ""  # Where both runs may leap over a feature of a formula, or an empty text
    enclosed: bool = False  # Whether the orbit of a map is known in balls, to its end

    @classmethod
    def of(cls, run: Trajectory) -> Observed:
        """Return a run paired with its second run for error estimates; cached with the run."""
        pair_runs = paired_orbit if run.law.is_map else paired
        return run.cached("observed", lambda: cls(run, *pair_runs(run)))

    @classmethod
    def alone(cls, run: Trajectory) -> Observed:
        """Return a run taken as exact up to rounding, without a second run."""
        zeros = np.zeros((len(run.t), run.n))
        return cls(run, run, run, Errors(run.t, zeros, zeros, zeros[:, 0], zeros[:, 0]), doubt_about(run))

    @property
    def law(self) -> Any:
        """Law of the run."""
        return self.run.law

    @property
    def n(self) -> int:
        """Number of agents of the run."""
        return self.run.n

    @property
    def m(self) -> int:
        """Dimension of space of the run."""
        return self.run.m

    @property
    def scales(self) -> Scales:
        """The law's natural length and time."""
        return self.run.scales

    @property
    def t(self) -> FloatArray:
        """Sample times, shape (T,)."""
        return self.run.t

    @property
    def is_map(self) -> bool:
        """Whether the law is a map, which has no state between its steps."""
        return self.law.is_map

    @property
    def floors(self) -> ErrorFloors:
        """Least errors of position, speed and work of the less accurate of the two runs."""
        return self.other.floors

    # half widths ---------------------------------------------------------------------------------------------------

    # of ‖q_i − q_c‖ and ‖p_i − p_c‖ of each agent at each sample, shape (T, n); of q_c and p_c, shape (T,)
    shape_error = cached_property(lambda self: self._at_samples(self.errors.shape, self.run.q))
    speed_error = cached_property(lambda self: self._at_samples(self.errors.speed, self.run.p))
    centre_error = cached_property(lambda self: self._at_samples(self.errors.centre, self.run.q))
    drift_error = cached_property(lambda self: self._at_samples(self.errors.drift, self.run.p))
    # of any q_i − q_c and p_i − p_c over each interval between samples, shape (T − 1,)
    between_error = cached_property(lambda self: self._between_samples(self.errors.shape, self.run.q))
    between_speed_error = cached_property(lambda self: self._between_samples(self.errors.speed, self.run.p))

    def _at_samples(self, errors: FloatArray, x: FloatArray) -> FloatArray:
        widths = self._windowed(errors, self.t, self.t)
        if self.begins_exactly:
            widths[0] = 0.0
        return widths + frame_error(x)

    def _between_samples(self, errors: FloatArray, x: FloatArray) -> FloatArray:
        return self._windowed(errors, self.t[:-1], self.t[1:]).max(axis=1) + frame_error(x)

    @property
    def begins_exactly(self) -> bool:
        """Whether the first sample is the exact start."""
        return not self.doubt and bool(self.t[0] == self.errors.t[0])

    def window(self, start: float, end: float) -> Observed:
        """Return the observed run restricted to given times, with its errors."""
        given_run, run, other_run = (item.window(start, end) for item in (self.given, self.run, self.other))
        return replace(self, given=given_run, run=run, other=other_run)

    def _windowed(self, errors: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return the largest error half width within one natural time of each interval (of a map, inside it)."""
        unit, times = 0.0 if self.is_map else self.run.scales.time, self.errors.t
        first = np.searchsorted(times, start - unit)
        return largest_over(errors, first, np.maximum(np.searchsorted(times, end + unit, side="right"), first + 1))

    @cached_property
    def known(self) -> int:
        """Number of samples before a map's orbit becomes unknown."""
        is_unknown = ~np.isfinite(self.shape_error).all(axis=1)
        return int(np.argmax(is_unknown)) if self.is_map and is_unknown.any() else len(self.t)

    @property
    def known_until(self) -> int | None:
        """Last known step of a map, counted from the first sample; None for a flow."""
        if not self.is_map or self.doubt:
            return None
        return round((float(self.t[self.known - 1]) - float(self.t[0])) / float(self.law.dt)) if self.known else 0

    def transformed(self, change: Callable[[Trajectory], Trajectory]) -> Observed:
        """Return both runs in another frame that keeps all distances between agents."""
        given_run, run, other_run = (change(item) for item in (self.given, self.run, self.other))
        return replace(self, given=given_run, run=run, other=other_run)

    # observables ---------------------------------------------------------------------------------------------------

    def series(self, observable: Callable[[Trajectory], Any], *, floor: Any = 0.0) -> Enclosure:
        """Return an observable over time, enclosed by its difference between the two runs."""
        best_series, other_series = (np.asarray(observable(run), dtype=np.float64) for run in (self.run, self.other))
        if self.doubt or len(best_series) != len(other_series):
            return Enclosure.around(best_series, np.inf)
        with np.errstate(invalid="ignore"):
            difference = DOUBT * np.abs(best_series - other_series)
        if self.is_map:
            difference[self.known :] = np.inf
        else:
            unit = self.run.scales.time
            starts = np.searchsorted(self.t, self.t - unit)
            difference = largest_over(difference, starts, np.searchsorted(self.t, self.t + unit, side="right"))
            if self.begins_exactly:
                difference[0] = 0.0
        return Enclosure.around(best_series, difference + floor)

    @property
    def accuracy_of_end(self) -> float:
        """Stated position error of the last sample: 0 for simulated runs."""
        return 0.0

    @property
    def allowed(self) -> tuple[Trajectory, ...]:
        """Other trajectories within the stated accuracy of the samples; empty for a simulated run."""
        return ()

    def sensitivity(self, observable: Callable[[Trajectory], Any]) -> Any:
        """Return the variation of an observable over states within the samples' accuracy; 0 for a run."""
        return 0.0

    @cached_property
    def energy(self) -> Enclosure:
        """Energy H at each sample, shape (T,)."""
        floor = np.where(self.t == self.errors.t[0], 0.0, self.floors.work)
        return self.series(Trajectory.energy, floor=floor + energy_rounding(self.run))

    @cached_property
    def residual(self) -> Enclosure:
        """Residual of the energy balance H − ∫ dH/dt at each sample, shape (T,)."""
        run = self.run
        work_rounding = float(run.stats.get("steps", len(run.t)) * EPS * np.abs(run.extra["work"]).max())
        rounding = 2.0 * energy_rounding(run) + work_rounding
        return self.series(lambda run: run.energy_residual, floor=self.floors.work + rounding)

    @cached_property
    def distances_from_centre(self) -> Enclosure:
        """Distances ‖q_i − q_c‖ at each sample, shape (T, n)."""
        return Enclosure.around(lengths(centred(self.run.q)), self.shape_error).clip(0.0)

    @cached_property
    def radius(self) -> Enclosure:
        """Cohesion radius at each sample, shape (T,)."""
        return self.distances_from_centre.max(axis=1)

    @cached_property
    def relative_speeds(self) -> Enclosure:
        """Relative speeds ‖p_i − p_c‖ at each sample, shape (T, n)."""
        return Enclosure.around(lengths(centred(self.run.p)), self.speed_error).clip(0.0)

    @cached_property
    def spread(self) -> Enclosure:
        """Position spread √Σ‖q_i − q_c‖² at each sample, shape (T,)."""
        return _norm(centred(self.run.q), self.shape_error)

    @cached_property
    def velocity_spread(self) -> Enclosure:
        """Velocity spread √Σ‖p_i − p_c‖² at each sample, shape (T,)."""
        return _norm(centred(self.run.p), self.speed_error)

    @cached_property
    def mismatch(self) -> Enclosure:
        """Normalised velocity mismatch K̃ = Σ‖p_i − p_c‖²/2n at each sample, shape (T,)."""
        return self.velocity_spread.square() / (2.0 * self.n)

    def distances(self, i: Any, j: Any) -> Enclosure:
        """Return distances of pairs of agents at each sample, shape (T, pairs)."""
        distances = lengths(self.run.q[:, j] - self.run.q[:, i])
        return Enclosure.around(distances, self.shape_error[:, i] + self.shape_error[:, j]).clip(0.0)

    @cached_property
    def end(self) -> End:
        """Last state of the run, with its errors."""
        return End(self.run.q[-1], self.run.p[-1], self.shape_error[-1], self.speed_error[-1])

    # spans ---------------------------------------------------------------------------------------------------------

    def known_samples(self, known: Any) -> int:
        """Return the number of samples before the first unknown one; 0 if they span too short a time."""
        unknown = np.flatnonzero(~np.asarray(known))
        count = int(unknown[0]) if unknown.size else len(self.t)
        is_complete = count == len(self.t) and count > 1
        is_long_enough = count > 1 and self.t[count - 1] - self.t[0] >= self.run.scales.time
        return count if is_complete or is_long_enough else 0

    def until(self, count: int) -> str:
        """Return in words the time up to which the first `count` samples reach."""
        return f"to t = {self.t[count - 1]:.4g}" if count else "at no time"


def observed(law: Any, q0: Any, p0: Any, t_span: tuple[float, float], **options: Any) -> Observed:
    """Simulate a law and return the run with its numerical error, for the cases of errata."""
    return Observed.of(ensure_uninterrupted(simulate(law, q0, p0, t_span, **options)))


def with_doubt(claims: Iterable[Claim], seen: Observed) -> tuple[Claim, ...]:
    """Return claims with a doubt about the run added to inconclusive ones; undecided for a failed run."""
    if seen.is_map and (seen.doubt or seen.known < len(seen.t)):
        claims = (_within_known_orbit(claim, seen) for claim in claims)
    if not seen.doubt:
        return tuple(claims)
    has_failed = bool(failure(seen.given))
    judged: list[Claim] = []
    for claim in claims:
        is_decided = claim.status in ("verified", "refuted") and has_failed and claim.rigour != "symbolic"
        status: Status = "inconclusive" if is_decided else claim.status
        detail = f"{claim.detail}; {seen.doubt}" if status == "inconclusive" else claim.detail
        judged.append(replace(claim, status=status, detail=detail.lstrip("; ")))
    return tuple(judged)


def _within_known_orbit(claim: Claim, seen: Observed) -> Claim:
    """Return a claim about a map, decided by numbers only within its known orbit."""
    if claim.status not in ("verified", "refuted") or claim.rigour not in ("numeric", "statistical"):
        return claim
    time = claim.witness.get("time", np.inf) if isinstance(claim.witness, dict) else np.inf
    if claim.status == "refuted" and not seen.doubt and seen.known and time <= seen.t[seen.known - 1]:
        return claim
    text = f"{claim.detail}; the orbit of the map is known to step {seen.known_until or 0} only".lstrip("; ")
    return replace(claim, status="inconclusive", detail=text)


def in_balls(claim: Claim) -> Claim:
    """Return a claim about a map's run with interval rigour, as its orbit is known in ball arithmetic."""
    return replace(claim, rigour="interval") if claim.rigour == "numeric" and claim.about == "run" else claim


def with_resolution(hypotheses: Needs, claims: Iterable[Claim], seen: Observed) -> Known:
    """Return hypotheses and claims, with an extra hypothesis if steps may not resolve the law."""
    claims = with_doubt(claims, seen)
    if not seen.unresolved:
        return tuple(hypotheses), claims
    requirement = Hypothesis(NAME, "assumed", detail=seen.unresolved)
    return (*hypotheses, requirement), tuple(with_hypothesis(claim, requirement) for claim in claims)


def with_hypothesis(claim: Claim, need: Hypothesis) -> Claim:
    """Return a claim under an extra hypothesis, unless proved or vacuous."""
    if claim.rigour not in ("numeric", "statistical") or claim.status == "vacuous":
        return claim
    status = with_needs(claim.status, (need,), claim.about)
    text = f"{claim.detail}; assumed: {need.name}" if claim.status in ("verified", "refuted") else claim.detail
    return replace(claim, status=status, needs=(*claim.needs, need), detail=text.lstrip("; "))


def by_both_runs(seen: Observed, check: Callable[[Trajectory], Claim]) -> Claim:
    """Return a claim from a function of a run, its margin enclosed by the difference of the two runs."""
    # For margins that are observables themselves. What is nonlinear in an error, such as a logarithm of what decays, is
    # made from enclosures of its parts instead.
    best, *other_claims = (check(run) for run in (seen.run, seen.other, *seen.allowed))
    if best.margin is None or best.status not in ("verified", "refuted"):
        return best
    other_claim = max(other_claims, key=lambda each: (each.status != best.status, _apart(best, each)))
    apart = _apart(best, other_claim)
    error = (best.error or 0.0) + (DOUBT * apart if best.margin != other_claim.margin else 0.0)
    if other_claim.status == best.status and abs(best.margin) > error:
        return replace(best, error=error)
    detail = f"{best.detail}; by the second run it is {other_claim.status}, with a margin that differs by {apart:.2g}"
    return replace(best, status="inconclusive", error=error, detail=detail.lstrip("; "))


def _apart(one: Claim, other: Claim) -> float:
    return np.inf if one.margin is None or other.margin is None else abs(one.margin - other.margin)


def _norm(x: FloatArray, errors: FloatArray) -> Enclosure:
    """Return the enclosed Euclidean norm, over all agents, of vectors with errors."""
    magnitudes = Enclosure.around(lengths(x), 0.0).square().sum(axis=1).sqrt()
    return magnitudes.widened(np.linalg.norm(errors, axis=1)).clip(0.0)
