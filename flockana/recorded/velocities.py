"""Velocities and accelerations from recorded positions, each with its error, and short gaps filled."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray, ensure_positive
from flockana.base.errors import ArgumentError
from flockana.base.vectors import lengths
from flockana.recorded.smoothing import smoothed

if TYPE_CHECKING:
    from flockana.recorded.recording import Recording

_TOLD = 2.0  # times the usual acceleration: a gap in which it is known less well is not filled
_FEWEST = 4  # samples of an agent from which velocities are made


@dataclass(frozen=True, eq=False)
class Motions:
    """Positions, velocities and accelerations by smoothing splines, shape (T, n, m), and standard deviations (T, n).

    Before an agent's first sample and after its last all are NaN.
    """

    q: FloatArray
    p: FloatArray
    u: FloatArray
    q_sd: FloatArray  # q_sd, p_sd, u_sd: of each coordinate
    p_sd: FloatArray
    u_sd: FloatArray
    carried: npt.NDArray[np.bool_]  # samples that were seen, and gaps in which the acceleration is still determined
    noise: float  # standard deviation of a coordinate, stated or estimated


def motions(rec: Recording) -> Motions:
    """Return the smoothing splines of a recording; its noise is the stated one, else the likeliest."""
    return rec.cached("motions", lambda: _motions(rec))


def _motions(rec: Recording) -> Motions:
    for name, samples in zip(rec.ids, rec.present.sum(axis=0), strict=True):
        if samples < _FEWEST:
            raise ArgumentError(
                f"agent {name} has {samples} samples: expected {_FEWEST} or more for velocities from positions; leave "
                "it out by select(agents=...)"
            )
    stated = rec.sd if rec.bound is None else 0.5 * rec.bound
    count, n, m = rec.q.shape
    noise = None if stated is None else np.repeat(np.broadcast_to(stated, (count, n)), m, axis=1)
    fit = smoothed(rec.t, rec.q.reshape(count, n * m), noise, groups=m)
    (q, p, u), deviations = ([x[:, :, k].reshape(count, n, m) for k in range(3)] for x in (fit.mean, fit.sd))
    q_sd, p_sd, u_sd = (each.max(axis=2) for each in deviations)
    within = np.maximum.accumulate(rec.present) & np.maximum.accumulate(rec.present[::-1])[::-1]
    for x in (q, p, u, q_sd, p_sd, u_sd):
        x[~within] = np.nan
    usual = np.sqrt(np.nanmean(np.where(rec.present, lengths(u) ** 2, np.nan), axis=0) / m)
    known = within & (np.nan_to_num(u_sd, nan=np.inf) <= _TOLD * usual)
    carried = rec.present.copy()
    for i, gap, _ in _gaps(rec):
        carried[gap, i] = known[gap, i].all()
    return Motions(q, p, u, q_sd, p_sd, u_sd, carried, fit.noise)


def with_velocities(rec: Recording) -> Recording:
    """See `Recording.with_velocities`: what rests on splines holds in a 0.99 band, so a bound turns into `sd`."""
    fit, seen = motions(rec), rec.present
    p, u = (np.where(seen[:, :, None], x, np.nan) for x in (fit.p, fit.u))
    p_sd = np.where(seen, fit.p_sd, 0.0)
    return replace(rec, p=p, u=u, p_sd=p_sd, p_bound=None, **_in_band(rec, fit))


def _in_band(rec: Recording, fit: Motions) -> dict[str, Any]:
    """Return the accuracy of a recording as a standard deviation: a bound counts as one, else the noise."""
    sd = rec.sd if rec.sd is not None else fit.noise if rec.bound is None else rec.bound
    return {"sd": sd, "bound": None, "estimated": rec.estimated or (rec.bound is None and rec.sd is None)}


def filled(rec: Recording, longest: float | None) -> Recording:
    """See `Recording.filled`."""
    if not rec.gaps:
        return rec
    fit = motions(rec)
    fill = ~rec.present & fit.carried
    most = np.inf if longest is None else ensure_positive("longest", longest)
    for i, gap, duration in _gaps(rec):
        fill[gap, i] &= duration <= most
    change = _in_band(rec, fit)
    change["sd"] = sd = np.where(fill, np.nan_to_num(fit.q_sd), change["sd"])
    if rec.p is not None:
        own = rec.p_sd if rec.p_sd is not None else rec.p_bound
        change["p_sd"] = np.where(fill, np.nan_to_num(fit.p_sd), sd / rec.interval if own is None else own)
        change["p_bound"] = None
    for name in ("q", "p", "u"):
        if (known := getattr(rec, name)) is not None:
            change[name] = np.where(fill[:, :, None], getattr(fit, name), known)
    return replace(rec, **change)


def _gaps(rec: Recording) -> Iterator[tuple[int, slice, float]]:
    """Yield gaps as agent, missing samples, and time from the sample before to the one after."""
    for i in range(rec.n):
        for a, b in pairwise(np.flatnonzero(rec.present[:, i]).tolist()):
            if b > a + 1:
                yield i, slice(a + 1, b), float(rec.t[b] - rec.t[a])
