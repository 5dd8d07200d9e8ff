"""Accelerations of a recorded flock: recorded ones, means over steps, or from splines."""

from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.recorded.law_contributions import over_samples, over_steps
from flockana.recorded.matching_windows import deviations
from flockana.recorded.one_step_predictions import kinematic_scheme
from flockana.recorded.recording import Recording
from flockana.recorded.velocities import Motions, motions

_FEWEST = 4  # samples for splines
_TWINS = 3  # random draws of the stated errors, to see how far these lead


class Accelerations(NamedTuple):
    """Accelerations u of shape (K, n, m) with errors, and their states (t, q, p).

    `basis` is "accelerations", at the samples; "steps", means from sample to sample; "map", those of a map's steps; or
    "splines".
    """

    basis: str
    t: FloatArray
    u: FloatArray
    error: FloatArray
    states: tuple[FloatArray, ...]
    scheme: str | None

    def of(self, part: Any) -> FloatArray:
        """Return the accelerations by a part of a law at the states and times of the recorded accelerations."""
        return over_steps(part, *self.states) if self.basis == "steps" else over_samples(part, *self.states)

    @property
    def weights(self) -> FloatArray:
        """Weights of residuals by the accuracy of the accelerations, shape (K, n); 1 where none is stated."""
        if self.basis != "splines":
            return np.ones(self.error.shape)
        typical_error = float(np.median(self.error)) or 1.0
        return 1.0 / ((self.error / typical_error) ** 2 + 1e-3)


def accelerations(rec: Recording) -> Accelerations:
    """Return the accelerations of a recording: recorded ones, else the more accurate of step means and splines."""
    if rec.u is not None and rec.p is not None and not rec.gaps:
        return Accelerations("accelerations", rec.t, rec.u, np.zeros(rec.q.shape[:2]), (rec.t, rec.q, rec.p), None)
    if rec.p is None or rec.gaps:
        return _of_splines(rec)
    if len(rec.t) < 2:
        raise ArgumentError("one sample without accelerations shows no law: expected two or more, or u=")
    steps = mean_accelerations(rec, rec.p)
    if rec.sd is None or not np.max(rec.sd) > 0.0 or len(rec.t) < _FEWEST:
        return steps
    splines = _of_splines(rec)
    return steps if np.median(steps.error) <= np.median(splines.error) else splines


def mean_accelerations(rec: Recording, p: FloatArray) -> Accelerations:
    """Return the mean accelerations from sample to sample, by recorded velocities."""
    h = np.diff(rec.t)
    u = np.diff(p, axis=0) / h[:, None, None]
    speed_error: Any = rec.accuracy.speed
    if rec.sd is not None:  # standard deviations, as those of splines are
        speed_error = rec.p_sd if rec.p_sd is not None else rec.sd / rec.interval
    speed = np.broadcast_to(speed_error, rec.q.shape[:2])
    error_sums = np.hypot(speed[1:], speed[:-1]) if rec.sd is not None else speed[1:] + speed[:-1]
    error = np.nan_to_num(error_sums / h[:, None], posinf=0.0)
    scheme, states = kinematic_scheme(rec), (rec.t, rec.q, p)
    if scheme is not None:  # then u is the input at the beginning of each step
        return Accelerations("accelerations", rec.t[:-1], u, error, tuple(x[:-1] for x in states), scheme)
    return Accelerations("steps", rec.t[:-1], u, error, states, None)


def drawn_errors(rec: Recording, fit: Motions | None = None) -> list[tuple[FloatArray, FloatArray]]:
    """Return a few draws of the stated errors of positions and velocities, or of those of splines; none if unstated."""
    if rec.sd is None and rec.bound is None:
        return []
    if fit is None:
        place, speed = (x.reshape(rec.q.shape) for x in np.split(deviations(rec, velocities=True), 2, axis=1))
    else:
        place, speed = fit.q_sd[:, :, None], fit.p_sd[:, :, None]
    rng = np.random.default_rng(0)
    return [(place * rng.standard_normal(rec.q.shape), speed * rng.standard_normal(rec.q.shape)) for _ in range(_TWINS)]


def noisy_twins(rec: Recording, data: Accelerations, law: Any) -> list[tuple[Accelerations, Any]]:
    """Return (accelerations, law) for a few draws of the stated errors, as if the flock obeyed the law exactly."""
    fit = motions(rec) if data.basis == "splines" else None
    rows = slice(len(data.t)) if fit is None else fit.known.all(axis=1)
    (t, q, p), exact, rng = data.states, data.of(lambda *state: law.flow(*state)[0]), np.random.default_rng(1)
    twins = []
    for place, speed in drawn_errors(rec, fit):
        if fit is not None:
            u = exact + data.error[:, :, None] * rng.standard_normal(exact.shape)
        elif data.basis == "steps" or data.scheme is not None:  # differences of velocities that have errors
            u = exact + np.diff(speed, axis=0) / np.diff(rec.t)[:, None, None]
        else:
            u = exact
        places, speeds = (x if data.basis == "steps" else x[rows] for x in (place, speed))
        twins.append((data._replace(u=u, states=(t, q + places, p + speeds)), law))
    return twins


def _of_splines(rec: Recording) -> Accelerations:
    """Return spline accelerations at samples with all agents known."""
    if len(rec.t) < _FEWEST:
        raise ArgumentError(f"{len(rec.t)} samples without accelerations: expected {_FEWEST} or more")
    fit = motions(rec)
    known_rows = fit.known.all(axis=1)
    if not known_rows.any():
        raise ArgumentError("no sample has all agents: take complete(), or leave agents out by select(agents=...)")
    t, q, p = rec.t[known_rows], fit.q[known_rows], fit.p[known_rows]
    return Accelerations("splines", t, fit.u[known_rows], fit.u_sd[known_rows], (t, q, p), None)
