"""Accelerations of a recorded flock: recorded ones, mean ones over steps, or those of splines."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.recorded.contributions import over_samples, over_steps
from flockana.recorded.recording import Recording
from flockana.recorded.schemes import Found, kinematic_scheme
from flockana.recorded.velocities import motions


class Accelerations(NamedTuple):
    """Accelerations u of shape (K, n, m) with their errors, and the states (t, q, p) that they belong to.

    `basis` is "accelerations", at the samples; "steps", means from sample to sample; or "splines".
    """

    basis: str
    t: FloatArray
    u: FloatArray
    error: FloatArray
    states: tuple[FloatArray, FloatArray, FloatArray]
    scheme: Found | None

    def of(self, part: Any) -> FloatArray:
        """Return the accelerations of a part of a law at the same places and times."""
        return over_steps(part, *self.states) if self.basis == "steps" else over_samples(part, *self.states)

    @property
    def weights(self) -> FloatArray:
        """Weights of residuals by the accuracy of the accelerations, shape (K, n); 1 where none is stated."""
        if self.basis != "splines":
            return np.ones(self.error.shape)
        typical = float(np.median(self.error)) or 1.0
        weights: FloatArray = 1.0 / ((self.error / typical) ** 2 + 1e-3)
        return weights


def accelerations(rec: Recording) -> Accelerations:
    """Return the accelerations of a recording, the recorded ones if there are any."""
    if rec.u is not None and rec.p is not None and not rec.gaps:
        return Accelerations("accelerations", rec.t, rec.u, np.zeros(rec.q.shape[:2]), (rec.t, rec.q, rec.p), None)
    noisy = rec.sd is not None and bool(np.max(rec.sd) > 0.0)
    if rec.p is None or noisy or rec.gaps:
        return _of_splines(rec)
    if len(rec.t) < 2:
        raise ArgumentError("one sample without accelerations shows no law: expected two or more, or u=")
    h = np.diff(rec.t)
    u = np.diff(rec.p, axis=0) / h[:, None, None]
    speed = np.broadcast_to(np.asarray(rec.accuracy.speed, dtype=np.float64), rec.q.shape[:2])
    error = np.nan_to_num((speed[1:] + speed[:-1]) / h[:, None], posinf=0.0)
    scheme = kinematic_scheme(rec)
    if scheme is not None:  # then u is the input at the beginning of each step
        return Accelerations("accelerations", rec.t[:-1], u, error, (rec.t[:-1], rec.q[:-1], rec.p[:-1]), scheme)
    return Accelerations("steps", rec.t[:-1], u, error, (rec.t, rec.q, rec.p), None)


def _of_splines(rec: Recording) -> Accelerations:
    """Accelerations where all agents are known."""
    if len(rec.t) < 4:
        raise ArgumentError(f"{len(rec.t)} samples without accelerations: expected 4 or more")
    fit = motions(rec)
    whole = fit.carried.all(axis=1) & ~np.isnan(fit.q).any(axis=(1, 2))
    if not whole.any():
        raise ArgumentError("at no time all agents are known: fill gaps, or leave agents out by select(agents=...)")
    t, q, p = rec.t[whole], fit.q[whole], fit.p[whole]
    return Accelerations("splines", t, fit.u[whole], fit.u_sd[whole], (t, q, p), None)
