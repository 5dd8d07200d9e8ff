"""Recognition of the integration scheme behind a recording."""

from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.laws.discrete import DiscreteLaw
from flockana.recorded.recording import Recording
from flockana.recorded.steps import predicted, rk4

_EXACT = 1e-9  # of the largest step: how exactly a scheme must reproduce the next sample
_EVEN = 1e-6  # of the interval, by which intervals may differ
_BETTER = 0.02  # of the error of the law's flow, which a scheme's must be below


def _even(rec: Recording) -> bool:
    steps = np.diff(rec.t)
    return len(steps) > 1 and bool(np.ptp(steps) <= _EVEN * rec.interval)


def kinematic_scheme(rec: Recording) -> str | None:
    """Return the name of the scheme of one step a sample that positions and velocities fit to rounding, if one does.

    Explicit Euler has q' = q + h p, semi-implicit Euler q' = q + h p', a Taylor step q' = q + h (p + p')/2; whatever
    the law is.
    """
    if rec.p is None or rec.gaps or not _even(rec):
        return None
    h, p = rec.interval, rec.p
    moved = np.diff(rec.q, axis=0)
    forms = {"explicit Euler": p[:-1], "semi-implicit Euler": p[1:], "Taylor steps": 0.5 * (p[:-1] + p[1:])}
    size = float(np.abs(rec.q).max()) * 1e-14 + _EXACT * float(np.abs(moved).max())
    turned = float(np.abs(np.diff(p, axis=0)).max()) * h
    for name, mean in forms.items():
        if turned > 100.0 * size and float(np.abs(moved - h * mean).max()) <= size:
            return name
    return None


def scheme_by_law(rec: Recording, law: Any) -> str | None:
    """Return the name of the scheme whose steps lead far closer to the next sample than the law's flow does."""
    if rec.p is None or rec.gaps or isinstance(law, DiscreteLaw) or not _even(rec):
        return None
    some = slice(0, 40)
    t, q, p, h = rec.t[some], rec.q[some], rec.p[some], rec.interval

    def off(ends: tuple[FloatArray, FloatArray]) -> float:
        return float(np.abs(ends[0] - q[1:]).max() / h + np.abs(ends[1] - p[1:]).max())

    exact = off(predicted(law, t, q, p))
    steps = [rk4(law, float(t[k]), h, q[k], p[k]) for k in range(len(t) - 1)]
    by_rk4 = off((np.array([a for a, _ in steps]), np.array([b for _, b in steps])))
    return "Runge-Kutta steps (RK4)" if by_rk4 < _BETTER * exact else None
