"""One-step predictions of recorded samples by a law, and recognition of the integration scheme."""

from math import ceil
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.recorded.recording import Recording

SHARE = 0.05  # of the law's time, which a step of the integration is at most
_MOST = 2000  # steps between two samples
_WHOLE = 1e-6  # of a step: how far an interval between samples may be from a whole number of steps
_EXACT = 1e-9  # of the largest step: how exactly a scheme must reproduce the next sample
_EVEN = 1e-6  # of the interval, by which intervals may differ
_BETTER = 0.02  # of the error of the law's flow, which a scheme's must be below


def predicted(
    law: Any, t: FloatArray, q: FloatArray, p: FloatArray, *, refine: int = 1
) -> tuple[FloatArray, FloatArray]:
    """Return a law's predictions of each next sample, positions and velocities of shape (T - 1, n, m)."""
    ends = np.empty((2, max(len(t) - 1, 0), *q.shape[1:]))
    for k in range(len(t) - 1):
        ends[0, k], ends[1, k] = led(law, float(t[k]), float(t[k + 1] - t[k]), q[k], p[k], refine=refine)
    return ends[0], ends[1]


def led(
    law: Any, t: float, h: float, q: FloatArray, p: FloatArray, *, refine: int = 1, share: float = SHARE
) -> tuple[FloatArray, FloatArray]:
    """Return the law's solution after a time h from a state."""
    if law.is_map:
        steps = round(h / law.dt)
        if steps < 1 or abs(h / law.dt - steps) > _WHOLE * max(steps, 1):
            raise ArgumentError(
                f"samples are {h:g} apart at t = {t:g}: expected whole steps of {law.title}, dt = {law.dt:g}; "
                "give the map that dt, or take other samples by select(samples=)"
            )
        memory = law.start(q, p)
        for k in range(steps):
            q, p, _, memory = law.step(t + k * law.dt, q, p, memory)
        return q, p
    time = h if law.scales is None else law.scales.time
    count = int(min(max(ceil(h / (share * time)), 1), _MOST)) * refine
    for k in range(count):
        q, p = rk4(law, t + k * h / count, h / count, q, p)
    return q, p


def rk4(law: Any, t: float, h: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the state after one step of the classical Runge-Kutta scheme."""
    u1 = law.flow(t, q, p)[0]
    p2 = p + 0.5 * h * u1
    u2 = law.flow(t + 0.5 * h, q + 0.5 * h * p, p2)[0]
    p3 = p + 0.5 * h * u2
    u3 = law.flow(t + 0.5 * h, q + 0.5 * h * p2, p3)[0]
    p4 = p + h * u3
    u4 = law.flow(t + h, q + h * p3, p4)[0]
    return q + h / 6.0 * (p + 2.0 * p2 + 2.0 * p3 + p4), p + h / 6.0 * (u1 + 2.0 * u2 + 2.0 * u3 + u4)


def _even(rec: Recording) -> bool:
    steps = np.diff(rec.t)
    return len(steps) > 1 and bool(np.ptp(steps) <= _EVEN * rec.interval)


def kinematic_scheme(rec: Recording) -> str | None:
    """Return the name of the one-step scheme that the samples satisfy to rounding; None without one.

    Explicit Euler has q' = q + h p, semi-implicit Euler q' = q + h p', a Taylor step q' = q + h (p + p')/2; whatever
    the law is.
    """
    if rec.p is None or rec.gaps or not _even(rec):
        return None
    h, p = rec.interval, rec.p
    steps = np.diff(rec.q, axis=0)
    forms = {"explicit Euler": p[:-1], "semi-implicit Euler": p[1:], "Taylor steps": 0.5 * (p[:-1] + p[1:])}
    tolerance = float(np.abs(rec.q).max()) * 1e-14 + _EXACT * float(np.abs(steps).max())
    turned = float(np.abs(np.diff(p, axis=0)).max()) * h
    for name, mean in forms.items():
        if turned > 100.0 * tolerance and float(np.abs(steps - h * mean).max()) <= tolerance:
            return name
    return None


def scheme_by_law(rec: Recording, law: Any) -> str | None:
    """Return the name of the scheme that predicts the next samples far better than the law's flow; None without one."""
    if rec.p is None or rec.gaps or law.is_map or not _even(rec):
        return None
    first_rows = slice(0, 40)
    t, q, p, h = rec.t[first_rows], rec.q[first_rows], rec.p[first_rows], rec.interval

    def off(ends: tuple[FloatArray, FloatArray]) -> float:
        return float(np.abs(ends[0] - q[1:]).max() / h + np.abs(ends[1] - p[1:]).max())

    exact = off(predicted(law, t, q, p))
    steps = [rk4(law, float(t[k]), h, q[k], p[k]) for k in range(len(t) - 1)]
    by_rk4 = off((np.array([a for a, _ in steps]), np.array([b for _, b in steps])))
    return "Runge-Kutta steps (RK4)" if by_rk4 < _BETTER * exact else None
