"""Windows of a recording, each matched by one solution of a law, and the solution's slopes."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.base.finite_differences import ORDER_2, central_differences
from flockana.base.value_checks import FloatArray
from flockana.recorded.one_step_predictions import led
from flockana.recorded.recording import Recording
from flockana.recorded.velocities import motions

_TIMES = 8.0  # of the law, which a window of samples is as long as
_PLACES = 8  # of a window, at which the law is linearised at least: with little gain its time is longer than contacts
_FEWEST = 40  # samples in a window
_NUDGE = 1e-5  # relative change of a parameter for slopes
_STEP = 0.4  # of the law's time, which a step of the integration is at most

Neighbour = tuple[Any, Any, float]  # laws with a parameter increased and decreased, and by how much


@dataclass(frozen=True, eq=False)
class Window:
    """Samples matched by one solution of a law: positions, and velocities if given.

    1/deviation of each number is 0 in gaps.
    """

    t: FloatArray
    y: FloatArray  # positions (K, n m), or positions and velocities (K, 2 n m)
    root: FloatArray
    start: FloatArray  # a first guess: positions and velocities, shape (2 n m,)
    m: int = 1

    def solution(self, law: Any, start: FloatArray, finer: int) -> FloatArray:
        """Return the states of a law's solution from a start, at the times of the samples, (K, 2 n m)."""
        return self._solution(law, self.t, start, finer)

    def _solution(self, law: Any, times: FloatArray, start: FloatArray, finer: int) -> FloatArray:
        states = np.empty((len(times), start.size))
        states[0], shape = start, (-1, self.m)
        q, p = (x.reshape(shape) for x in np.split(start, 2))
        for k in range(1, len(times)):
            t, h = float(times[k - 1]), float(times[k] - times[k - 1])
            q, p = led(law, t, h, q, p, refine=finer, share=_STEP)
            states[k] = np.concatenate([q.ravel(), p.ravel()])
        return states

    def residual(self, law: Any, start: FloatArray, finer: int, shift: FloatArray | float = 0.0) -> FloatArray:
        """Return the residuals of a law's solution divided by noise deviations, shape (K w,); 0 in gaps.

        `shift` (w,) is a constant error of the samples.
        """
        width = self.y.shape[1]
        deviation = np.nan_to_num(self.y - self.solution(law, start, finer)[:, :width] - shift)
        return (self.root * deviation).ravel()

    def slopes(self, law: Any, nearby: list[Neighbour], start: FloatArray, finer: int, block: float) -> FloatArray:
        """Return the derivatives of the law's solution by start and parameters, divided by noise deviations."""
        longest = np.inf if law.scales is None else block * law.scales.time
        parts = [max(1, min(ceil(h / longest), 64)) for h in np.diff(self.t).tolist()]
        times, boundaries = self.t[:1], np.concatenate([[0], np.cumsum(parts)]).astype(int)
        if len(parts):
            pieces = [np.linspace(a, b, m + 1)[1:] for a, b, m in zip(self.t[:-1], self.t[1:], parts, strict=True)]
            times = np.concatenate([times, *pieces])
        states = self._solution(law, times, start, finer)
        dimension, width = start.size // 2, self.y.shape[1]
        now = np.concatenate([np.eye(2 * dimension), np.zeros((2 * dimension, len(nearby)))], axis=1)
        all_slopes = np.empty((len(times), width, now.shape[1]))
        all_slopes[0] = now[:width]
        step = min(_within(times, longest), max(1, len(times) // _PLACES))
        for a in range(0, len(times) - 1, step):
            b = min(a + step, len(times) - 1)
            t, middle = 0.5 * float(times[a] + times[b]), (a + b) // 2
            q, p = (x.reshape(-1, self.m) for x in np.split(0.5 * (states[middle] + states[a + b - middle]), 2))
            propagator = _propagator(law, nearby, t, q, p)
            for k in range(a, b):
                now = propagator(now, float(times[k + 1] - times[k]))
                all_slopes[k + 1] = now[:width]
        rows = all_slopes[boundaries] * self.root[:, :, None]
        return rows.reshape(len(self.t) * width, -1)


def _propagator(
    law: Any, nearby: list[Neighbour], t: float, q: FloatArray, p: FloatArray
) -> Callable[[FloatArray, float], FloatArray]:
    """Return the function that propagates derivatives by start and parameters over a step, by linearisation."""
    size = q.size
    by_q, by_p = _derivatives(law, t, q, p)
    forced = np.zeros((size, 2 * size + len(nearby)))
    for k, (raised_law, less, value_step) in enumerate(nearby):
        forced[:, 2 * size + k] = (raised_law.flow(t, q, p)[0] - less.flow(t, q, p)[0]).ravel() / value_step

    def rate(x: FloatArray) -> FloatArray:
        return np.concatenate([x[size:], by_q @ x[:size] + by_p @ x[size:]])

    def propagate(slope: FloatArray, h: float) -> FloatArray:
        term = h * rate(slope)
        term[size:] += h * forced
        total = slope + term
        for order in (2.0, 3.0):
            term = h / order * rate(term)
            total += term
        return total

    return propagate


def _within(t: FloatArray, time: float) -> int:
    """Return the number of samples within a duration, at least 1."""
    return max(1, int(min(len(t), time / float(np.median(np.diff(t)) if len(t) > 1 else 1.0))))


def usual_window(rec: Recording, law: Any) -> float:
    """Return the usual duration of a window: several time scales of the law, at least some sample intervals."""
    return max(0.0 if law.scales is None else _TIMES * law.scales.time, _FEWEST * rec.interval)


def deviations(rec: Recording, *, velocities: bool) -> FloatArray:
    """Return the standard deviation of each recorded coordinate, (T, w): stated, from a bound, or estimated."""
    place = rec.sd if rec.sd is not None else motions(rec).noise if rec.bound is None else rec.bound / np.sqrt(3.0)
    each = [np.broadcast_to(np.asarray(place, dtype=np.float64), rec.present.shape)]
    if velocities and rec.p is not None:
        speed = rec.p_sd if rec.p_sd is not None else None if rec.p_bound is None else rec.p_bound / np.sqrt(3.0)
        speed = each[0] / rec.interval if speed is None else speed
        each.append(np.broadcast_to(np.asarray(speed, dtype=np.float64), rec.present.shape))
    noise_columns = np.concatenate([np.repeat(x, rec.m, axis=1) for x in each], axis=1)
    size = float(np.nanmax(np.abs(rec.q - np.nanmean(rec.q, axis=(0, 1))))) or 1.0
    finest_errors = np.repeat([1e-12 * size, 1e-12 * size / rec.interval][: len(each)], rec.n * rec.m)
    return np.maximum(noise_columns, finest_errors)


def windows(rec: Recording, duration: float, sd: FloatArray | None = None) -> list[Window]:
    """Return the windows of a recording, each of about a given duration; `sd` tells whether velocities are data."""
    fit, (total, n, m) = motions(rec), rec.q.shape
    sd = deviations(rec, velocities=False) if sd is None else sd
    count = max(1, round(float(rec.t[-1] - rec.t[0]) / duration))
    edges = np.unique(np.linspace(0, total, count + 1).astype(int))
    y = rec.q.reshape(total, n * m)
    if sd.shape[1] > n * m and rec.p is not None:
        y = np.concatenate([y, rec.p.reshape(total, n * m)], axis=1)
    root = np.where(np.isnan(y), 0.0, 1.0 / sd)
    guess = _guess(rec, fit.q, fit.p)
    parts = []
    for a, b in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        if b - a >= 2 and (rec.present[a:b].sum(axis=0) >= 2).all():
            k = a + int(np.argmax(rec.present[a:b].all(axis=1)))  # where all are seen, if they are
            parts.append(Window(rec.t[k:b], y[k:b], root[k:b], guess[k], m))
    if not parts:
        raise ArgumentError("no window of samples holds all agents: expected some time at which all were seen")
    return parts


def _guess(rec: Recording, q: FloatArray, p: FloatArray) -> FloatArray:
    """Return guessed states at all samples, (T, 2 n m): smoothed or recorded, linearly interpolated elsewhere."""
    total, n, m = rec.q.shape
    q = np.where(np.isnan(q), rec.q, q).reshape(total, n * m)
    p = (p if rec.p is None else np.where(np.isnan(rec.p), p, rec.p)).reshape(total, n * m)
    guess = np.empty((total, 2 * n * m))
    for k in range(n * m):
        rows = np.flatnonzero(~np.isnan(q[:, k]))
        guess[:, k] = np.interp(rec.t, rec.t[rows], q[rows, k])
        known_rows = np.flatnonzero(~np.isnan(p[:, k]))
        slopes = np.gradient(guess[:, k], rec.t) if total > 1 else np.zeros(total)
        guess[:, n * m + k] = np.interp(rec.t, rec.t[known_rows], p[known_rows, k]) if known_rows.size else slopes
    return guess


def rescaled(parts: list[Window], factors: FloatArray) -> list[Window]:
    """Return the windows with the deviations of each column multiplied by a factor, shape (w,)."""
    return [replace(segment, root=segment.root / factors) for segment in parts]


def _derivatives(law: Any, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return (∂u/∂q, ∂u/∂p), by differences if the law has none."""
    try:
        a, b = law.derivatives(t, q, p)
        return a.toarray(), b.toarray()
    except (FlockanaError, NotImplementedError):
        flows = (lambda x: law.flow(t, x, p)[0], q), (lambda x: law.flow(t, q, x)[0], p)
        widths = [_NUDGE * (float(np.ptp(x)) or float(np.abs(x).max()) or 1.0) for _, x in flows]
        slopes = (central_differences(*flow, width, ORDER_2)[0] for flow, width in zip(flows, widths, strict=True))
        return next(slopes), next(slopes)


def neighbouring_laws(with_values: Callable[[FloatArray], Any], values: FloatArray) -> list[Neighbour]:
    """Return for each parameter the laws with increased and decreased value, and the difference."""
    laws = []
    for k, value in enumerate(values.tolist()):
        raised_values, less = values.copy(), values.copy()
        nudge_size = _NUDGE * (abs(value) or 1.0)
        raised_values[k], less[k] = value + nudge_size, value - nudge_size if value != 0.0 else 0.0
        laws.append((with_values(raised_values), with_values(less), float(raised_values[k] - less[k])))
    return laws
