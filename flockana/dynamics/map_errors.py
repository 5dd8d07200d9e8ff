"""Errors of a map's run, from a second orbit that begins a rounding beside the first.

Agreement of two orbits is an estimate of what rounding makes of one, not an enclosure; where they part nothing is known
any more.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.base.vectors import lengths
from flockana.dynamics.iterate import discrete
from flockana.dynamics.sample import Tally
from flockana.dynamics.trajectory import Trajectory

DOUBT = 4.0  # times what the orbits differ by
PARTED = 1e-3  # of the law's length and speed: two orbits that differ by more have parted
_ROUNDINGS = 8.0  # of the largest coordinate: the least nudge, to which each step adds one
EPS = float(np.finfo(np.float64).eps)


class MapErrors(NamedTuple):
    """Errors of a map's run at its samples: half widths of each agent's position and velocity, shape (T, n)."""

    q: FloatArray
    p: FloatArray
    known_until: float  # last time at which they are finite; before the first sample if none is
    enclosed: bool  # whether they are enclosures; else estimates
    reason: str = ""  # why they end before the run does

    @classmethod
    def of(cls, run: Trajectory, q: FloatArray, p: FloatArray, *, enclosed: bool, reason: str) -> MapErrors:
        """Return errors that are known until they first are larger than what counts as parted."""
        speed = run.scales.length / run.scales.time
        limits = PARTED * run.scales.length, PARTED * max(speed, float(np.abs(run.p).max()))
        lost = ~((q <= limits[0]).all(axis=1) & (p <= limits[1]).all(axis=1))
        first = int(np.argmax(lost)) if lost.any() else len(run.t)
        q, p = np.where(np.arange(len(run.t))[:, None] < first, (q, p), np.inf)
        known = float(run.t[first - 1]) if first else -np.inf
        return cls(q, p, known, enclosed, reason if first < len(run.t) else "")


def nudged_errors(run: Trajectory) -> MapErrors:
    """Return the errors of a map's run as two more orbits show them: the same start, and one a rounding beside it.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.solvers.taylor_step import TaylorStep
    >>> run = simulate(TaylorStep(Algorithm1(), 0.01), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> errors = nudged_errors(run)
    >>> errors.known_until, errors.enclosed, bool(errors.q.max() < 1e-11)
    (1.0, False, True)
    """
    steps = round(float(run.t[-1] - run.t[0]) / run.law.dt)
    size = (_ROUNDINGS + steps) * EPS
    signs = np.random.default_rng(0).choice((-1.0, 1.0), (2, *run.q[0].shape))
    sizes = zip((run.q[0], run.p[0]), _units(run), strict=True)
    length, speed = (size * max(float(np.abs(x).max()), least) for x, least in sizes)
    q, p = np.full((2, len(run.t), run.n), np.inf)
    orbits = [(run.q[0], run.p[0]), (run.q[0] + length * signs[0], run.p[0] + speed * signs[1])]
    apart = []
    for start in orbits:
        states = _orbit(run, *start)
        rows = len(states[0])
        own = np.full((2, len(run.t), run.n), np.inf)
        own[:, :rows] = lengths(states[0] - run.q[:rows]), lengths(states[1] - run.p[:rows])
        apart.append(own)
    q, p = DOUBT * np.fmax(*apart)
    follows = bool((apart[0][0] <= PARTED * run.scales.length).all())
    reason = "two orbits that begin a rounding apart have parted"
    if not follows:
        reason = "the map does not lead from the first sample to the others"
    return MapErrors.of(run, q + length, p + speed, enclosed=False, reason=reason)


def _units(run: Trajectory) -> tuple[float, float]:
    return run.scales.length, run.scales.length / run.scales.time


def _orbit(run: Trajectory, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return (q, p) at the run's samples of the orbit from a start, as far as it leads."""
    span, t = (float(run.t[0]), float(run.t[-1])), run.t
    try:
        made: list[Any] = list(discrete(run.law, q, p, span, t, Tally()))
    except ArgumentError:
        made = []
    none = np.empty((0, *q.shape))
    return np.concatenate([none, *(some.q for some in made)]), np.concatenate([none, *(some.p for some in made)])
