"""Solutions of a law matched to noisy positions: each window of samples has a start of its own, found with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError, FlockanaError
from flockana.recorded.recording import Recording
from flockana.recorded.steps import rk4, substeps
from flockana.recorded.velocities import motions

_ROUNDS = 40  # of Gauss and Newton, damped
_SETTLED = 0.01  # standard errors by which a round moves every parameter, below which the search ends
_GAIN = 1e-2  # of squared deviations, that a round must gain for a start to be sought further
_NUDGE = 1e-5  # relative change of a parameter for slopes
_STEP = 0.1  # of the law's time, which a step of the integration is at most
_LEAST = 1e-6  # of its first value, below which no positive parameter goes
_FELT = 1e-6  # squared deviations that a parameter moves the residuals by, if it is doubled, for it to be told
_DAMPED = 1e8  # damping beyond which nothing is left to try


class Matched(NamedTuple):
    """Parameters with the covariance of noise 1, the squares that are left, how many numbers, and how it ended."""

    values: FloatArray
    covariance: FloatArray
    told: npt.NDArray[np.bool_]  # parameters that the residuals feel
    squares: float
    freedom: int
    message: str


class _Slopes(NamedTuple):
    """Residuals of a window over their deviations, and their slopes in the start and in the parameters."""

    residual: FloatArray
    by_start: FloatArray
    by_parameter: FloatArray


@dataclass(frozen=True, eq=False)
class Window:
    """Samples that one solution of a law is matched to: 1/deviation of each coordinate (K, n m) is 0 in gaps."""

    t: FloatArray
    q: FloatArray
    root: FloatArray
    start: FloatArray  # a first guess: positions and velocities, shape (2 n m,)

    def residual(self, law: Any, start: FloatArray, nearby: list[tuple[Any, Any, float]]) -> _Slopes:
        """Return the residuals of a law's solution from a start, with their slopes."""
        seen, size = self.root.ravel() > 0.0, start.size // 2
        places, slopes = along(law, self.t, start, self.q.shape[1:], nearby)
        off = np.where(self.root > 0.0, np.nan_to_num(self.q.reshape(self.root.shape)) - places, 0.0)
        scaled = (slopes * self.root[:, :, None]).reshape(len(seen), -1)[seen]
        return _Slopes((self.root * off).ravel()[seen], scaled[:, : 2 * size], scaled[:, 2 * size :])


def windows(rec: Recording, duration: float) -> list[Window]:
    """Return the windows of a recording, each of about some duration."""
    fit = motions(rec)
    count = max(1, round(float(rec.t[-1] - rec.t[0]) / duration))
    edges = np.unique(np.linspace(0, len(rec.t), count + 1).astype(int))
    sd = np.broadcast_to(np.asarray(fit.noise if rec.sd is None else rec.sd, dtype=np.float64), rec.q.shape[:2])
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


def matched(parts: list[Window], with_values: Callable[[FloatArray], Any], first: FloatArray) -> Matched:
    """Return the parameters by which solutions of a law match windows of samples best, the starts found with them."""
    theta, starts, damping = first.copy(), [part.start for part in parts], 0.0
    now = _evaluated(parts, with_values, theta, starts)
    if now is None:
        raise ArgumentError("the law cannot be integrated from the recorded starts: expected other first parameters")
    message = f"no end after {_ROUNDS} rounds"
    for _ in range(_ROUNDS):
        normal, gradient, back, open_ = _normal_equations(now, len(theta))
        covariance = np.linalg.pinv(normal)
        moved = np.linalg.pinv(normal + damping * np.diag(np.diag(normal))) @ gradient
        if open_ + float(gradient @ moved) <= _GAIN:
            message = "settled"
            break
        share = _share(theta, moved, first)
        tried_theta = theta + share * moved
        tried_starts = [x + share * step(moved) for x, step in zip(starts, back, strict=True)]
        tried = _evaluated(parts, with_values, tried_theta, tried_starts)
        if tried is None or _squares(tried) > _squares(now) * (1.0 + 1e-12):
            damping = max(10.0 * damping, 1e-2)
            if damping > _DAMPED:
                message = "no smaller residual was found nearby"
                break
            starts = [x + 0.1 * share * step(0.0 * moved) for x, step in zip(starts, back, strict=True)]
            retried = _evaluated(parts, with_values, theta, starts)
            now = now if retried is None else retried
            continue
        errors = np.sqrt(np.maximum(np.diag(covariance), 0.0))
        settled = bool((np.abs(share * moved) <= _SETTLED * errors + 1e-12 * np.abs(theta)).all()) and damping < 1e-3
        gained = _squares(now) - _squares(tried)
        theta, starts, now, damping = tried_theta, tried_starts, tried, 0.1 * damping if damping > 1e-4 else 0.0
        if settled and gained <= 1e-3 * max(_squares(now), 1e-300):
            message = "settled"
            break
    normal, _, _, _ = _normal_equations(now, len(theta))
    size = sum(len(each.residual) for each in now)
    freedom = max(size - sum(x.size for x in starts) - len(theta), 1)
    told = np.diag(normal) * theta**2 > _FELT
    return Matched(theta, np.asarray(np.linalg.pinv(normal), np.float64), told, _squares(now), freedom, message)


def match_start(law: Any, part: Window) -> tuple[FloatArray, FloatArray]:
    """Return the start from which a law's solution matches a window best, and the residuals over their deviations."""
    start, now = part.start, part.residual(law, part.start, [])
    for _ in range(_ROUNDS):
        moved = np.linalg.lstsq(now.by_start, now.residual, rcond=None)[0]
        for share in (1.0, 0.3, 0.1, 0.03):
            tried = part.residual(law, start + share * moved, [])
            if float(tried.residual @ tried.residual) < float(now.residual @ now.residual):
                break
        else:
            break
        gained = float(now.residual @ now.residual) - float(tried.residual @ tried.residual)
        start, now = start + share * moved, tried
        if gained <= _GAIN:
            break
    return start, now.residual


def _evaluated(parts: list[Window], with_values: Any, theta: FloatArray, starts: list[FloatArray]) -> Any:
    """Residuals and slopes of all windows; None if there is no such law, or its solution is not finite."""
    try:
        law, nearby = with_values(theta), nearby_laws(with_values, theta)
        found = [part.residual(law, start, nearby) for part, start in zip(parts, starts, strict=True)]
    except FlockanaError:
        return None
    return found if all(np.isfinite(each.residual).all() for each in found) else None


def _squares(found: list[_Slopes]) -> float:
    return float(sum(each.residual @ each.residual for each in found))


def _share(theta: FloatArray, moved: FloatArray, first: FloatArray) -> float:
    """How much of a step may be taken while every positive parameter stays above a tenth of itself."""
    falls = (first > 0.0) & (moved < 0.0)
    room = np.where(falls, (0.9 * theta - _LEAST * first) / np.where(falls, -moved, 1.0), np.inf)
    return float(min(1.0, np.maximum(room, 1e-3).min(initial=1.0)))


def _normal_equations(found: list[_Slopes], count: int) -> tuple[FloatArray, FloatArray, list[Any], float]:
    """Normal equations of the parameters with all starts eliminated, how starts follow a step, and what they gain."""
    normal, gradient, back, gain = np.zeros((count, count)), np.zeros(count), list[Any](), 0.0
    for each in found:
        basis, corner = np.linalg.qr(each.by_start)
        across = basis.T @ each.by_parameter
        slopes, along_basis = each.by_parameter - basis @ across, basis.T @ each.residual
        normal += slopes.T @ slopes
        gradient += slopes.T @ each.residual
        gain += float(along_basis @ along_basis)
        back.append(_follower(corner, along_basis, across))
    return normal, gradient, back, gain


def _follower(corner: FloatArray, along_basis: FloatArray, across: FloatArray) -> Any:
    inverse = np.linalg.pinv(corner)

    def step(moved: FloatArray) -> FloatArray:
        found: FloatArray = inverse @ (along_basis - across @ moved)
        return found

    return step


def along(
    law: Any, t: FloatArray, start: FloatArray, shape: tuple[int, ...], nearby: list[tuple[Any, Any, float]]
) -> tuple[FloatArray, FloatArray]:
    """Return the places of a law's solution (K, n m), and their slopes in the start and in parameters."""
    size = start.size // 2
    q, p = start[:size].reshape(shape).copy(), start[size:].reshape(shape).copy()
    slope = np.concatenate([np.eye(2 * size), np.zeros((2 * size, len(nearby)))], axis=1)
    places, slopes = np.empty((len(t), size)), np.empty((len(t), size, slope.shape[1]))
    for k in range(len(t)):
        if k:
            before, h = float(t[k - 1]), float(t[k] - t[k - 1])
            count, first_q, first_p = substeps(law, h, _STEP), q, p
            for s in range(count):
                q, p = rk4(law, before + s * h / count, h / count, q, p)
            slope = _carried(law, before + 0.5 * h, h, 0.5 * (first_q + q), 0.5 * (first_p + p), slope, nearby)
        places[k], slopes[k] = q.ravel(), slope[:size]
    return places, slopes


def _carried(
    law: Any, t: float, h: float, q: FloatArray, p: FloatArray, slope: FloatArray, nearby: list[tuple[Any, Any, float]]
) -> FloatArray:
    """Slopes after a step, by the law's linearisation in its middle, to the fourth order of the step."""
    size = q.size
    by_q, by_p = _derivatives(law, t, q, p)
    forced = np.zeros((2 * size, slope.shape[1]))
    for k, (more, less, by) in enumerate(nearby):
        forced[size:, 2 * size + k] = (more.flow(t, q, p)[0] - less.flow(t, q, p)[0]).ravel() / by

    def rate(x: FloatArray) -> FloatArray:
        return np.concatenate([x[size:], by_q @ x[:size] + by_p @ x[size:]])

    term = h * (rate(slope) + forced)
    total = slope + term
    for order in (2.0, 3.0, 4.0):
        term = h / order * rate(term)
        total = total + term
    return total


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


def nearby_laws(with_values: Callable[[FloatArray], Any], values: FloatArray) -> list[tuple[Any, Any, float]]:
    """Return for each parameter the law with more and with less of it, and the difference."""
    found = []
    for k, value in enumerate(values.tolist()):
        more, less = values.copy(), values.copy()
        by = _NUDGE * (abs(value) or 1.0)
        more[k], less[k] = value + by, value - by if value != 0.0 else 0.0
        found.append((with_values(more), with_values(less), float(more[k] - less[k])))
    return found
