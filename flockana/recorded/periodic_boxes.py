"""Unwrapping of positions in a periodic box, from sample to sample."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.recorded.recording import Recording

_WIDEST = 1.5  # periods that positions extend over, with their noise, if they are wrapped
_HALF = 0.5  # of a period: a longer step is taken for one the other way


def unwrapped(rec: Recording, box: Any) -> Recording:
    """Return a recording whose positions are unwrapped from a periodic box.

    A step that leads beyond half a period is taken for a shorter one the other way round, or, where velocities were
    recorded, for the one nearest to what these lead to. So steps must be shorter than half a period: the longest that
    was seen and the largest change from one to the next together, over as long as an agent was not seen.

    Parameters
    ----------
    rec : Recording
        The recording.
    box : float or sequence of float
        Period along each axis, inf where there is none.

    Raises
    ------
    ArgumentError
        If a step may be longer than half a period.

    Examples
    --------
    >>> unwrapped(Recording([0.0, 1.0, 2.0], [[[0.7]], [[0.9]], [[0.1]]]), 1.0).q.ravel()
    array([0.7, 0.9, 1.1])
    """
    try:
        box_lengths = np.broadcast_to(np.asarray(box, dtype=np.float64), (rec.m,))
    except (TypeError, ValueError):
        box_lengths = np.zeros(rec.m)
    if not (box_lengths > 0.0).all():
        raise ArgumentError(f"box = {box!r}: expected a period > 0, or {rec.m}, one for each axis, inf for none")
    period = np.where(np.isfinite(box_lengths), box_lengths, 1.0)
    span = np.nanmax(rec.q, axis=(0, 1)) - np.nanmin(rec.q, axis=(0, 1))
    if (is_too_wide := span > _WIDEST * box_lengths).any():
        k = int(np.argmax(is_too_wide))
        raise ArgumentError(
            f"box = {box!r}: positions extend over {span[k]:.4g} along {'xyz'[k]}: expected wrapped ones; "
            "give the box in the unit of positions, or leave it out if they are unwrapped"
        )
    q = rec.q.copy()
    for i in range(rec.n):
        rows = np.flatnonzero(rec.present[:, i])
        h = np.diff(rec.t[rows])[:, None]
        predicted_steps = np.zeros((len(h), rec.m)) if rec.p is None else h * _mean_velocity(rec.p[rows, i])
        deviation = np.diff(rec.q[rows, i], axis=0) - predicted_steps
        short = np.where(np.isfinite(box_lengths), deviation - period * np.rint(deviation / period), deviation)
        _ensure_short(rec, i, short, predicted_steps, h, box_lengths)
        q[rows[1:], i] = q[rows[0], i] + np.cumsum(predicted_steps + short, axis=0)
    note = f"unwrapped from a box of {', '.join(f'{x:g}' for x in box_lengths)}"
    return replace(rec, q=q, read_as=(*rec.read_as, note))


def _mean_velocity(p: FloatArray) -> FloatArray:
    return np.nan_to_num(0.5 * (p[1:] + p[:-1]))


def _ensure_short(
    rec: Recording, i: int, short: FloatArray, ahead: FloatArray, h: FloatArray, size: FloatArray
) -> None:
    """Raise if an agent may move more than half a period of the box between two samples."""
    median_step = float(np.median(h)) if len(h) else 1.0
    rate = np.abs(short) / h
    is_dense = h[:, 0] <= 1.5 * median_step
    fastest = rate[is_dense].max(axis=0, initial=0.0)
    rate_changes = [np.abs(rate[b] - rate[a]) for a, b in pairwise(np.flatnonzero(is_dense).tolist()) if b == a + 1]
    rate_change = np.max(rate_changes, axis=0, initial=0.0) if rate_changes else np.zeros(rec.m)
    reach = np.maximum((fastest + rate_change) * h, np.abs(short))
    if (is_invalid := reach >= _HALF * size).any():
        k, axis = (int(x) for x in np.argwhere(is_invalid)[0])
        rows = np.flatnonzero(rec.present[:, i])
        note = " beyond its velocity" if rec.p is not None else ""
        raise ArgumentError(
            f"agent {rec.ids[i]} may move by {reach[k, axis]:.3g}{note} from t = {rec.t[rows[k]]:g} to "
            f"{rec.t[rows[k + 1]]:g} along {'xyz'[axis]}, half of the period {size[axis]:g} or more: "
            "expected shorter steps; sample more often, give velocities, or leave the agent out"
        )
