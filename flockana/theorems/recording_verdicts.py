"""Verdicts on recordings: whether the samples follow the law, and theorems within their accuracy.

The first hypothesis is that each sample is where the law leads from the one before, within the stated accuracy. If it
is, the law's solution from the recorded start is judged, on enclosures that hold the recording, too: as wide as the two
differ, the accuracy added, at worst within one time unit of the law before and after; an observable is as wide as it
differs between the solution and states at the ends of the enclosure. Limits are certified from the last state if its
whole enclosure lies in a basin. Without a law, definitions about samples are judged alone.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.vector_norms import centres
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.laws.discrete import ensure_law
from flockana.recorded.follows_law import Following, following
from flockana.recorded.recording import Recording
from flockana.theorems.evidence import Evidence
from flockana.theorems.observed_run import Observed, with_resolution
from flockana.theorems.run_verdicts import examine_observed, theorems_about
from flockana.theorems.second_runs import DOUBT, Errors, centred, doubt_about
from flockana.theorems.theorem import HypothesisStatus, Known, Theorem
from flockana.theorems.theorem_toolkit import (
    Claim,
    Enclosure,
    FloatArray,
    Hypothesis,
    Tolerances,
    Trajectory,
    lengths,
    vacuous,
)

DEFINITIONS = ("alpha-flocking", "alpha-flocking-strict", "os-5-terminal")  # which need no law
_WAYS = 3  # random directions in which states are moved to the ends of their enclosures


@dataclass(frozen=True, eq=False)
class ObservedRecording(Observed):
    """Law's solution from a recorded start, with enclosures of the recording (`given`)."""

    place: float = 0.0  # accuracy of the last positions
    begins_exactly = False  # the recorded start is known to its accuracy

    @property
    def accuracy_of_end(self) -> float:
        """Error of the last recorded positions."""
        return self.place

    def sensitivity(self, observable: Callable[[Trajectory], Any]) -> FloatArray:
        """Return the variation of an observable between the solution and states within the accuracy."""
        best_series = np.asarray(observable(self.run), dtype=np.float64)
        widest = np.zeros(best_series.shape)
        for allowed_run in self.allowed:
            with np.errstate(invalid="ignore"):
                deviation = np.abs(np.asarray(observable(allowed_run), dtype=np.float64) - best_series)
            widest = np.maximum(widest, DOUBT * np.where(np.isnan(deviation), np.inf, deviation))
        return widest

    def series(self, observable: Callable[[Trajectory], Any], *, floor: Any = 0.0) -> Enclosure:
        """Return an observable over time, widened to the states within the accuracy."""
        return super().series(observable, floor=floor + self.sensitivity(observable))

    @property
    def residual(self) -> Enclosure:
        """Residual of the energy balance of the law's solution, as a recording has no work."""
        return Observed(self.given, self.run, self.other, self.errors, self.doubt).residual

    @property
    def allowed(self) -> tuple[Trajectory, ...]:
        """Recording, and states at the ends of the enclosures, in some directions and along the forces."""
        return self.cached("allowed", self._allowed)

    def _allowed(self) -> tuple[Trajectory, ...]:
        run, rng = self.run, np.random.default_rng(0)
        position_error = (self.shape_error + self.centre_error[:, None])[:, :, None]
        off_p = (self.speed_error + self.drift_error[:, None])[:, :, None]
        recorded_run = replace(self.given, extra=run.extra) if len(self.given.t) == len(run.t) else run
        directions = [tuple(_unit(rng.normal(size=run.q.shape)) for _ in range(2)) for _ in range(_WAYS)]
        directions.append((_unit(run.u), _unit(centred(run.p))))
        if not (np.isfinite(position_error).all() and np.isfinite(off_p).all()):
            return (recorded_run,)
        signed_nudges = [(sign * position_error * a, sign * off_p * b) for a, b in directions for sign in (1.0, -1.0)]
        return (recorded_run, *(replace(run, q=run.q + x, p=run.p + v, between=None) for x, v in signed_nudges))


def _unit(x: FloatArray) -> FloatArray:
    magnitudes = lengths(x)[:, :, None]
    return np.divide(x, magnitudes, out=np.zeros_like(x), where=magnitudes > 0.0)


class RecordingEvidence(Evidence):
    """Recording with the law said to have made it, or with scale and range of nets."""

    def __init__(self, rec: Recording, law: Any = None, d: float | None = None, r: float | None = None) -> None:
        self.rec, self.law, self.d, self.r, self.until = rec, law, d, r, float(rec.t[-1])

    def describe(self, subject: str) -> str:  # noqa: D102
        rec = self.rec.measured
        source_note = f" ({rec.source})" if rec.source else ""
        name = subject or f"a recording{source_note}"
        return (
            f"{name}: {rec.accuracy}" if self.law is not None else f"{name}, at its samples: {self._moving().accuracy}"
        )

    def theorem_ids(self) -> tuple[str, ...]:  # noqa: D102
        self.rec.ensure_complete("a verdict")
        if self.law is None:
            return DEFINITIONS
        rec = self._moving()
        assert rec.p is not None
        return theorems_about(ensure_law(self.law), rec.q[0], rec.p[0], float(rec.t[0]))

    def examine(self, item: Theorem, tolerances: Tolerances) -> Known:  # noqa: D102
        if item.kind != "trajectory":
            raise ArgumentError(f"{item.id} is not about motion: expected a theorem that is checked on a run")
        self.rec.ensure_complete("a verdict")
        rec = self.rec.measured
        if self.law is None:
            return self._examine_samples(item, tolerances)
        if self.d is not None or self.r is not None:
            raise ArgumentError("law and d or r are given: expected one of them; a law has its own scale and range")
        law = ensure_law(self.law)
        law.check_dimension(rec.m)
        law.check_agents(rec.n)
        follow = rec.cached(f"following {id(law)}", lambda: (law, following(rec, law)))[1]  # whose number no other gets
        first = Hypothesis("the samples follow the law", follow.status, follow.margin, follow.detail, None, "enclosed")
        if follow.status == "unmet":
            return (first,), item.vacuous_claims(first) or (vacuous("all", first, by=item.author),)
        observation = rec.cached(f"observed under {id(law)}", lambda: observed_recording(rec, law, follow))
        return _weighed(examine_observed(item, observation, tolerances), rec, first)

    def _moving(self) -> Recording:
        """Return the recording, with velocities added if it has none."""
        rec = self.rec.measured
        return rec if rec.p is not None else rec.with_velocities()

    def _examine_samples(self, item: Theorem, tolerances: Tolerances) -> Known:
        """Return a definition's result on a recording's samples, without assumptions between them."""
        if item.id not in DEFINITIONS:
            raise ArgumentError(
                f"{item.id} is about a law: expected verify({item.id!r}, recording, law=...); without one, "
                f"{', '.join(DEFINITIONS)} are judged with d= and r="
            )
        if self.d is None and self.r is None:
            raise ArgumentError("no law, no d and no r: expected law=..., or the scale d and the range r of nets")
        rec = self._moving()
        run = rec.trajectory(d=self.d, r=self.r)
        position_error, speed = _widths(rec)
        errors = Errors(run.t, *_half_widths(position_error, speed))
        doubt = "" if len(run.t) > 1 else "one sample shows no motion"
        observation = ObservedRecording(run, run, run, errors, doubt, place=float(position_error[-1].max()))
        status: HypothesisStatus = "met" if rec.accuracy.decides else "assumed"
        stated_claim = Hypothesis("the accuracy of the samples is stated", status, detail=str(rec.accuracy))
        return _weighed(with_resolution(*item.examine(observation, tolerances), observation), rec, stated_claim)


def _half_widths(place: FloatArray, speed: FloatArray) -> tuple[FloatArray, ...]:
    """Return error bounds of deviations from the centre and of the centre, from those of the agents."""
    mean_widths = place.mean(axis=1), speed.mean(axis=1)
    return place + mean_widths[0][:, None], speed + mean_widths[1][:, None], *mean_widths


def _widths(rec: Recording) -> tuple[FloatArray, FloatArray]:
    """Return the stated accuracy of a recording's positions and velocities, shape (T, n) each."""
    position_error, speed = (np.asarray(item, dtype=np.float64) for item in (rec.accuracy.place, rec.accuracy.speed))
    return np.broadcast_to(position_error, rec.q.shape[:2]), np.broadcast_to(speed, rec.q.shape[:2])


def observed_recording(rec: Recording, law: Any, follow: Following) -> ObservedRecording:
    """Return the law's solution from the recorded start, with enclosures of the recording."""
    span = float(rec.t[0]), float(rec.t[-1])
    run = ensure_uninterrupted(simulate(law, follow.q0, follow.p0, span, t_eval=rec.t))
    seen = Observed.of(run)
    p = np.broadcast_to(follow.p, rec.q.shape)
    zeros = np.zeros(rec.q.shape)
    trajectory = Trajectory(rec.t, rec.q, p, zeros, law, {}, run.status, run.message, {"steps": len(rec.t) - 1})
    if seen.doubt or len(run.t) != len(rec.t) or doubt_about(trajectory):
        doubt = seen.doubt or doubt_about(trajectory) or "the run ended"
        return ObservedRecording(trajectory, run, seen.other, seen.errors, doubt)
    place, (apart, slip) = _widths(rec)[0], (rec.q - run.q, p - run.p)
    speed = np.broadcast_to(np.asarray(follow.speed, dtype=np.float64), rec.q.shape[:2])
    if not rec.accuracy.decides:
        place, speed = np.zeros(place.shape), np.zeros(speed.shape)
    differ = *map(lengths, map(centred, (apart, slip))), *(lengths(centres(x)[:, None])[:, 0] for x in (apart, slip))
    off = [a + b for a, b in zip(differ, _half_widths(place, speed), strict=True)]
    times, end = seen.errors.t, float(place[-1].max())
    if law.is_map:
        orbit_errors = [x + y for x, y in zip(seen.errors[1:], off, strict=True)]
        return ObservedRecording(trajectory, run, seen.other, Errors(rec.t, *orbit_errors), place=end)
    next_samples = np.minimum(np.searchsorted(rec.t, times, side="left"), len(rec.t) - 1)
    before = np.maximum(np.searchsorted(rec.t, times, side="right") - 1, 0)
    widened_errors = [x + np.maximum(y[before], y[next_samples]) for x, y in zip(seen.errors[1:], off, strict=True)]
    return ObservedRecording(
        trajectory, run, seen.other, Errors(times, *widened_errors), unresolved=seen.unresolved, place=end
    )


def _weighed(known: Known, rec: Recording, first: Hypothesis) -> Known:
    """Return hypotheses with an extra first one, and claims weakened as the recording's accuracy demands."""
    return (first, *known[0]), tuple(_weighed_claim(claim, rec, first) for claim in known[1])


def _weighed_claim(claim: Claim, rec: Recording, first: Hypothesis) -> Claim:
    """Return a claim, weakened as the recording's accuracy demands; undecided under an assumed hypothesis."""
    if claim.status not in ("verified", "refuted"):
        return claim
    if first.status != "met":
        detail = f"{claim.detail}; nothing is decided, as it is only assumed that {first.name}: {first.detail}"
        return replace(claim, status="inconclusive", detail=detail.lstrip("; "))
    return replace(claim, rigour="statistical" if rec.accuracy.kind == "sd" else "numeric")
