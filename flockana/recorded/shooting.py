"""Solutions of a law matched to noisy positions, with an estimated start for each window of samples.

Parameters and starts are sought together by the method of Gauss and Newton. Residuals are divided by the noise, so that
they are independent with deviation 1, and an error of the integration whose residuals have the norm x moves a parameter
by at most x standard errors; the steps are chosen by it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError, FlockanaError
from flockana.recorded.recording import Recording
from flockana.recorded.steps import led
from flockana.recorded.velocities import motions

_ROUNDS = 120  # residuals that are computed at most
_TIMES = 8.0  # of the law, which a window of samples is as long as
_FEWEST = 40  # samples in a window
_GAIN = 1e-2  # of squared deviations, that a round must promise for the search to go on
_NUDGE = 1e-5  # relative change of a parameter for slopes
_STEP = 0.4  # of the law's time, which a step of the integration is at most
_FINEST = 32  # times finer steps may be
_BLURRED = 0.05  # standard errors that the integration may move a parameter by
_COARSE, _FINE = 0.4, 0.1  # of the law's time, over which slopes are carried by one linearisation, at first and at last
_CLOSE = 0.3  # gain that coarse slopes promise, from which on they are fine
_NEAR = 1.0  # gain of steps by the same slopes, within which these still give the covariance
_LEAST = 1e-6  # of its first value, below which no positive parameter goes
_FELT = 1e-6  # least change of the squared residuals by doubling a parameter that makes it identifiable
_DAMPED = 1e8  # damping beyond which nothing is left to try
_TRUSTED = 0.5  # by which a gain may differ from the one that slopes promise; else they are computed anew


_Neighbour = tuple[Any, Any, float]  # laws with a parameter increased and decreased, and by how much


class MatchResult(NamedTuple):
    """Result of matching: parameters, covariance for unit noise, starts, residuals, their number, and outcome."""

    values: FloatArray
    covariance: FloatArray
    identifiable: npt.NDArray[np.bool_]  # parameters that the residuals feel
    starts: list[FloatArray]
    residuals: list[FloatArray]
    freedom: float
    message: str

    @property
    def squares(self) -> float:
        """Sum of the squared residuals."""
        return _squares(self.residuals)

    @property
    def variance(self) -> float:
        """Variance of the residuals; 1 if they are noise of the stated deviation."""
        return self.squares / self.freedom


@dataclass(frozen=True, eq=False)
class Window:
    """Samples that one solution of a law is matched to: 1/deviation of each coordinate (K, n m) is 0 in gaps."""

    t: FloatArray
    q: FloatArray
    root: FloatArray
    start: FloatArray  # a first guess: positions and velocities, shape (2 n m,)

    def solution(self, law: Any, start: FloatArray, finer: int) -> tuple[FloatArray, FloatArray]:
        """Return positions and velocities of a law's solution from a start at the samples, shape (K, n, m)."""
        q, p = np.empty(self.q.shape), np.empty(self.q.shape)
        q[0], p[0] = start.reshape(2, *self.q.shape[1:])
        for k in range(1, len(self.t)):
            t, h = float(self.t[k - 1]), float(self.t[k] - self.t[k - 1])
            q[k], p[k] = led(law, t, h, q[k - 1], p[k - 1], refine=finer, share=_STEP)
        return q, p

    def residual(self, law: Any, start: FloatArray, finer: int) -> FloatArray:
        """Return the residuals of a law's solution over their deviations, shape (K n m,); 0 in gaps."""
        off = np.nan_to_num(self.q - self.solution(law, start, finer)[0])
        return (self.root * off.reshape(self.root.shape)).ravel()

    def slopes(self, law: Any, nearby: list[_Neighbour], start: FloatArray, finer: int, block: float) -> FloatArray:
        """Return the slopes of the law's solution over deviations in start and parameters, (K n m, 2 n m + P)."""
        q, p = self.solution(law, start, finer)
        size, (count, width) = start.size // 2, self.root.shape
        now = np.concatenate([np.eye(2 * size), np.zeros((2 * size, len(nearby)))], axis=1)
        found = np.empty((count, width, now.shape[1]))
        found[0] = now[:size]
        scales = law.scales
        step = _within(self.t, np.inf if scales is None else block * scales.time)
        for a in range(0, count - 1, step):
            b = min(a + step, count - 1)
            t, middle = 0.5 * float(self.t[a] + self.t[b]), (a + b) // 2
            state = [0.5 * (x[middle] + x[a + b - middle]) for x in (q, p)]
            propagate = _propagator(law, nearby, t, *state)
            for k in range(a, b):
                now = propagate(now, float(self.t[k + 1] - self.t[k]))
                found[k + 1] = now[:size]
        found *= self.root[:, :, None]
        return found.reshape(count * width, -1)


def _propagator(
    law: Any, nearby: list[_Neighbour], t: float, q: FloatArray, p: FloatArray
) -> Callable[[FloatArray, float], FloatArray]:
    """Return the function that carries slopes over a step, to its third order, by the law's linearisation."""
    size = q.size
    by_q, by_p = _derivatives(law, t, q, p)
    forced = np.zeros((size, 2 * size + len(nearby)))
    for k, (more, less, by) in enumerate(nearby):
        forced[:, 2 * size + k] = (more.flow(t, q, p)[0] - less.flow(t, q, p)[0]).ravel() / by

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
    """Return how many samples lie within a duration, at least 1."""
    return max(1, int(min(len(t), time / float(np.median(np.diff(t)) if len(t) > 1 else 1.0))))


def usual_window(rec: Recording, law: Any) -> float:
    """Return the duration of windows: several of the law's times, and of many samples."""
    return max(0.0 if law.scales is None else _TIMES * law.scales.time, _FEWEST * rec.interval)


def windows(rec: Recording, duration: float) -> list[Window]:
    """Return the windows of a recording, each of about some duration."""
    fit = motions(rec)
    count = max(1, round(float(rec.t[-1] - rec.t[0]) / duration))
    edges = np.unique(np.linspace(0, len(rec.t), count + 1).astype(int))
    sd = np.broadcast_to(fit.noise if rec.sd is None else rec.sd, rec.present.shape)
    root = np.repeat(np.where(rec.present, 1.0 / np.maximum(sd, 1e-300), 0.0), rec.m, axis=1)
    found = []
    for a, b in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        known = ~np.isnan(fit.q[a:b]).any(axis=(1, 2))
        k = a + int(np.argmax(known))
        if not known.any() or b - k < 3:
            continue
        start = np.concatenate([fit.q[k].ravel(), fit.p[k].ravel()])
        found.append(Window(rec.t[k:b], rec.q[k:b], root[k:b], start))
    if not found:
        raise ArgumentError("no window of samples holds all agents: expected some time at which all were seen")
    return found


@dataclass(frozen=True, eq=False)
class _NormalEquations:
    """Normal equations of starts and parameters: slopes of each window, and the starts eliminated."""

    slopes: list[FloatArray]
    corners: list[FloatArray]  # inverse of each start's own block
    across: list[FloatArray]  # block between a start and the parameters
    reduced: FloatArray
    damping: float

    @classmethod
    def of(cls, slopes: list[FloatArray], count: int, damping: float) -> Self:
        reduced, corners, across = np.zeros((count, count)), [], []
        for each in slopes:
            whole = each.T @ each
            whole[np.diag_indices_from(whole)] *= 1.0 + damping
            size = len(whole) - count
            corners.append(_inverse(whole[:size, :size]))
            across.append(whole[:size, size:])
            reduced += whole[size:, size:] - across[-1].T @ corners[-1] @ across[-1]
        return cls(slopes, corners, across, reduced, damping)

    @property
    def covariance(self) -> FloatArray:
        """Covariance of the parameters for noise of deviation 1."""
        return _inverse(self.reduced)

    def step(self, residuals: list[FloatArray]) -> tuple[FloatArray, list[FloatArray], float]:
        """Return the step of the parameters and of each start, and the predicted decrease of the squares."""
        count, starts, gained = len(self.reduced), [], 0.0
        downhill = [each.T @ off for each, off in zip(self.slopes, residuals, strict=True)]
        parts = [(x[: x.size - count], x[x.size - count :]) for x in downhill]
        blocks = list(zip(parts, self.corners, self.across, strict=True))
        moved = self.covariance @ sum(
            (own - across.T @ (corner @ start) for (start, own), corner, across in blocks), np.zeros(count)
        )
        for (start, own), corner, across in blocks:
            starts.append(corner @ (start - across @ moved))
            gained += float(start @ starts[-1]) + float(own @ moved)
        return moved, starts, gained


def _inverse(matrix: FloatArray) -> FloatArray:
    """Pseudoinverse of a symmetric matrix that is scaled to 1 on its diagonal."""
    if not len(matrix):
        return matrix
    size = np.sqrt(np.diag(matrix))
    unit = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)
    return unit[:, None] * np.linalg.pinv(unit[:, None] * matrix * unit, 1e-14, hermitian=True) * unit


def matched(parts: list[Window], with_values: Callable[[FloatArray], Any], first: FloatArray) -> MatchResult:
    """Return the parameters, and starts of windows, for which solutions of a law fit the samples best.

    Slopes are kept as long as steps gain what these promise: most rounds cost solutions alone.
    """
    theta, starts, damping = first.copy(), [part.start for part in parts], 0.0
    finer, block, since, message = _refinement(parts, with_values(theta)), _COARSE, 0.0, ""
    now = _residuals(parts, with_values, theta, starts, finer)
    if now is None:
        raise ArgumentError("the law cannot be integrated from the recorded starts: expected other first parameters")
    normal, size = None, sum(int(np.count_nonzero(part.root)) for part in parts)
    for _ in range(_ROUNDS):
        if normal is None:
            since, normal = 0.0, _normal(parts, with_values, theta, starts, finer, block, damping=damping)
        moved, moves, promised = normal.step(now)
        unit = max(_squares(now) / size, 1.0)  # residuals of a law that does not fit are larger than noise
        if promised <= (_GAIN if block == _FINE else _CLOSE) * unit:
            if block == _FINE and since <= _NEAR * unit and normal.damping == 0.0:
                message = "settled"
                break
            block, damping, normal = _FINE, 0.0, None
            continue
        part_of = _share(theta, moved, first)
        tried_theta = theta + part_of * moved
        tried_starts = [x + part_of * move for x, move in zip(starts, moves, strict=True)]
        tried = _residuals(parts, with_values, tried_theta, tried_starts, finer)
        gained = 0.0 if tried is None else _squares(now) - _squares(tried)
        if tried is not None and gained > 0.0:
            theta, starts, now, since = tried_theta, tried_starts, tried, since + gained
            damping = 0.1 * damping if damping > 1e-4 else 0.0
        elif since == 0.0:
            damping = max(10.0 * damping, 1e-2)
            if damping > _DAMPED:
                message = "no smaller residual was found nearby"
                break
        if not since or normal.damping or abs(gained - promised) > _TRUSTED * promised:
            normal = None
    if message != "settled" or normal is None:
        message = message or f"no end after {_ROUNDS} rounds"
        normal = _normal(parts, with_values, theta, starts, finer, _FINE)
    freedom = max(size - sum(x.size for x in starts) - len(theta), 1)
    identifiable = np.diag(normal.reduced) * theta**2 > _FELT
    return MatchResult(theta, normal.covariance, identifiable, starts, now, freedom, message)


def _refinement(parts: list[Window], law: Any) -> int:
    """Return how much finer steps must be for their error to be negligible against the standard errors."""
    finer, coarse = 1, [part.residual(law, part.start, 1) for part in parts]
    while finer < _FINEST:
        fine = [part.residual(law, part.start, 2 * finer) for part in parts]
        if _squares([a - b for a, b in zip(coarse, fine, strict=True)]) <= _BLURRED**2:
            break
        finer, coarse = 2 * finer, fine
    return finer


def _residuals(
    parts: list[Window], with_values: Any, theta: FloatArray, starts: list[FloatArray], finer: int
) -> list[FloatArray] | None:
    """Return residuals of all windows; None if the law refuses the parameters, or its solution is not finite."""
    try:
        law = with_values(theta)
        found = [part.residual(law, start, finer) for part, start in zip(parts, starts, strict=True)]
    except FlockanaError:
        return None
    return found if all(np.isfinite(each).all() for each in found) else None


def _normal(
    parts: list[Window], with_values: Any, theta: FloatArray, starts: list[FloatArray], *by: Any, damping: float = 0.0
) -> _NormalEquations:
    law, nearby = with_values(theta), _neighbouring_laws(with_values, theta)
    slopes = [part.slopes(law, nearby, start, *by) for part, start in zip(parts, starts, strict=True)]
    return _NormalEquations.of(slopes, len(theta), damping)


def _squares(found: list[FloatArray]) -> float:
    return float(sum(each @ each for each in found))


def _share(theta: FloatArray, moved: FloatArray, first: FloatArray) -> float:
    """Return the fraction of a step that keeps every positive parameter above a tenth of its value."""
    falls = (first > 0.0) & (moved < 0.0)
    room = np.where(falls, (0.9 * theta - _LEAST * first) / np.where(falls, -moved, 1.0), np.inf)
    return float(min(1.0, np.maximum(room, 1e-3).min(initial=1.0)))


def _derivatives(law: Any, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(∂u/∂q, ∂u/∂p), by differences where the law has none."""
    try:
        a, b = law.derivatives(t, q, p)
        return a.toarray(), b.toarray()
    except (FlockanaError, NotImplementedError):
        return _differences(lambda x: law.flow(t, x, p)[0], q), _differences(lambda x: law.flow(t, q, x)[0], p)


def _differences(function: Callable[[FloatArray], FloatArray], x: FloatArray) -> FloatArray:
    unit, columns = _NUDGE * (float(np.abs(x).max()) or 1.0), []
    for k in range(x.size):
        nudge: FloatArray = np.zeros(x.shape)
        nudge[np.unravel_index(k, x.shape)] = unit
        columns.append((function(x + nudge) - function(x - nudge)).ravel() / (2.0 * unit))
    return np.stack(columns, axis=1)


def _neighbouring_laws(with_values: Callable[[FloatArray], Any], values: FloatArray) -> list[_Neighbour]:
    """Return for each parameter the laws with it increased and decreased, and the difference."""
    found = []
    for k, value in enumerate(values.tolist()):
        more, less = values.copy(), values.copy()
        by = _NUDGE * (abs(value) or 1.0)
        more[k], less[k] = value + by, value - by if value != 0.0 else 0.0
        found.append((with_values(more), with_values(less), float(more[k] - less[k])))
    return found
