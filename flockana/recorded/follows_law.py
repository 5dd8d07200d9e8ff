"""Test of whether the samples of a recording follow a law, within their stated accuracy."""

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.error_tolerances import rounding_floors
from flockana.recorded.accuracy import CONFIDENCE
from flockana.recorded.matching_windows import Window, usual_window, windows
from flockana.recorded.one_step_predictions import SHARE, led, predicted
from flockana.recorded.recording import Recording
from flockana.recorded.shooting import Problem, matched

_WAYS = 3  # random directions in which samples are moved by their accuracy, to see how far that leads
_GROWN = 2.0  # times the largest of these: what an error of the accuracy's size may grow to
_NEAREST = 100  # agents whose errors are added up, each at its worst, before a sample counts as off
_ROUNDINGS = 1e3  # of the numbers in the law's own arithmetic between two samples
_AT_MOST = 50_000  # steps of a law that follow a recording: some ten seconds of a small flock


@dataclass(frozen=True, eq=False)
class Following:
    """Result of checking whether samples follow a law, with start and velocities for the law's solution.

    Attributes
    ----------
    status : {"met", "unmet", "assumed"}
        "assumed" where no accuracy is stated.
    margin : float
        Allowed less actual distance at the worst place, over the allowed.
    detail : str
        In words: by how much, when, and which agent.
    q0, p0 : ndarray, shape (n, m)
        Where the law's solution starts.
    p : ndarray, shape (T, n, m)
        Velocities at the samples.
    speed : float or ndarray, shape (T, n)
        Their accuracy.
    """

    status: Literal["met", "unmet", "assumed"]
    margin: float
    detail: str
    q0: FloatArray
    p0: FloatArray
    p: FloatArray
    speed: Any


def following(rec: Recording, law: Any) -> Following:
    """Return whether a recording follows a law: from sample to sample, or over windows if noise is stated."""
    rec = rec.measured
    if len(rec.t) < 2:
        raise ArgumentError("one sample shows no motion: expected two or more")
    if rec.p is None or (rec.sd is not None and bool(np.max(rec.sd) > 0.0)):
        return _over_windows(rec, law)
    return _from_sample_to_sample(rec, law)


def _from_sample_to_sample(rec: Recording, law: Any) -> Following:
    """Compare each sample with predictions from the previous sample and from one time scale of the law earlier."""
    assert rec.p is not None
    _ensure_few_steps(rec, law)
    place, speed = (np.broadcast_to(x, rec.present.shape) for x in (rec.accuracy.place, rec.accuracy.speed))
    is_known = bool(np.isfinite(place).all())
    worst: list[tuple[float, float, str, float, int]] = []
    wide = 1 if law.scales is None else max(1, int(law.scales.time / rec.interval))
    for stride in {1, wide} if len(rec.t) > wide else {1}:  # dense samples are compared one law time apart too
        times, q, p = rec.t[::stride], rec.q[::stride], rec.p[::stride]
        widths = [x[::stride] if is_known else np.zeros(q.shape[:2]) for x in (place, speed)]
        distances, allowances = _differences(law, times, q, p, *widths)
        for name, deviations, allowance in zip(("q", "p"), distances, allowances, strict=True):
            ratio = deviations / allowance
            k, i = np.unravel_index(int(np.argmax(ratio)), ratio.shape)
            worst.append((float(ratio[k, i]), float(deviations[k, i]), name, float(times[k + 1]), int(i)))
    excess, size, name, t, agent = max(worst)
    worst_text, accuracy = f"{name} of agent {rec.ids[agent]} at t = {t:.6g}", rec.accuracy
    reach = " and ".join(f"{max(item[1] for item in worst if item[2] == kind):.3g} in {kind}" for kind in "qp")
    status: Literal["met", "unmet", "assumed"] = "met" if accuracy.decides else "assumed"
    if not is_known:
        excess, text = 1.0, f"off by {reach} (worst: {worst_text}); no accuracy is stated"
    elif excess > 1.0:
        status, text = "unmet", f"{worst_text} is off by {size:.3g} where {size / excess:.3g} is allowed, {accuracy}"
    else:
        text = f"within {reach} from sample to sample (worst: {worst_text}), {accuracy}"
    return Following(status, 1.0 - excess, text, rec.q[0], rec.p[0], rec.p, speed)


def _ensure_few_steps(rec: Recording, law: Any) -> None:
    """Raise if following a recording would take minutes of integration steps."""
    if law.is_map or law.scales is None:
        return
    time, span = law.scales.time, float(rec.t[-1] - rec.t[0])
    if (steps := span / (SHARE * time)) > _AT_MOST:
        raise ArgumentError(
            f"{len(rec.t)} samples over {span:g}, where the law's own time is {time:.3g}: following them takes "
            f"{steps:.3g} steps, expected at most {_AT_MOST}; are both in one unit of time? Else judge a shorter part"
        )


def _differences(
    law: Any, t: FloatArray, q: FloatArray, p: FloatArray, place: FloatArray, speed: FloatArray
) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]:
    """Return distances of samples from the law's predictions, and the allowed distances from all errors."""
    near, fine = predicted(law, t, q, p), predicted(law, t, q, p, refine=2)
    ends = tuple(b + (b - a) / 15.0 for a, b in zip(near, fine, strict=True))  # Richardson's, of a scheme of order 4
    off = lengths(q[1:] - ends[0]), lengths(p[1:] - ends[1])
    rng, grown = np.random.default_rng(0), [np.zeros(off[0].shape), np.zeros(off[0].shape)]
    if place.any() or speed.any():
        for _ in range(_WAYS):
            ways = rng.normal(size=(2, *q.shape))
            ways /= np.linalg.norm(ways, axis=3, keepdims=True)
            changes = predicted(law, t, q + place[:, :, None] * ways[0], p + speed[:, :, None] * ways[1])
            for k in range(2):
                widest = lengths(changes[k] - near[k]).max(axis=1, keepdims=True)
                grown[k] = np.maximum(grown[k], np.broadcast_to(widest, off[0].shape))
    floors = rounding_floors(t, q, p, np.diff(p, axis=0) / np.diff(t)[:, None, None], np.empty(0))
    smallest_float = np.finfo(float).tiny
    allowances = tuple(
        own_changes[1:] + _GROWN * grown[k] + 2.0 * lengths(fine[k] - ends[k]) + _ROUNDINGS * floor + smallest_float
        for k, (own_changes, floor) in enumerate(((place, floors.place), (speed, floors.speed)))
    )
    excesses = np.max([deviation / allowance for deviation, allowance in zip(off, allowances, strict=True)], axis=0)
    for k in np.argsort(-excesses.max(axis=1), kind="stable").tolist() if place.any() or speed.any() else ():
        if excesses[k].max() <= 1.0:
            break
        largest = _largest_changes(law, t[k : k + 2], (q[k], p[k]), (place[k], speed[k]), int(np.argmax(excesses[k])))
        for allowance, sizes, row in zip(allowances, largest, grown, strict=True):
            allowance[k] += _GROWN * np.maximum(sizes - row[k], 0.0)
        if any((deviation[k] > allowance[k]).any() for deviation, allowance in zip(off, allowances, strict=True)):
            break  # it is off, whatever the others are
    return off, (allowances[0], allowances[1])


def _largest_changes(
    law: Any, t: FloatArray, state: tuple[FloatArray, FloatArray], errors: tuple[FloatArray, FloatArray], agent: int
) -> FloatArray:
    """Return how far errors of the agents near one can move a law's prediction together, to first order, (2, n)."""
    start, h = float(t[0]), float(t[1] - t[0])
    end, total = led(law, start, h, *state), np.zeros((2, len(state[0])))
    for j in np.argsort(lengths(state[0] - state[0][agent]))[:_NEAREST].tolist():
        for kind in (0, 1):
            squares = np.zeros(total.shape)
            for axis in range(state[0].shape[1]):
                nudged = [x.copy() for x in state]
                nudged[kind][j, axis] += errors[kind][j]
                nudged_end = led(law, start, h, nudged[0], nudged[1])
                squares += [lengths(one - other) ** 2 for one, other in zip(nudged_end, end, strict=True)]
            total += np.sqrt(squares)
    return total


def _over_windows(rec: Recording, law: Any) -> Following:
    """Compare the residuals of solutions, matched to windows of noisy positions, with the stated noise."""
    from scipy.stats import chi2, norm

    if law.is_map:
        raise ArgumentError(
            f"noisy positions under the map {law.title}: expected its continuous law, or velocities and bound="
        )
    duration, smooth = usual_window(rec, law), rec.with_velocities()
    assert smooth.p is not None
    parts, largest = windows(rec, duration), (0.0, 0.0, 0)
    try:
        match = matched(Problem(parts, lambda _: law, np.empty(0)))
        is_off = [bool(x @ x > chi2.isf((1.0 - CONFIDENCE) / 2.0 / len(parts), x.size)) for x in match.residuals]
        if any(is_off):
            starts = [_extended_start(*x, law) for x in zip(parts, match.starts, is_off, strict=True)]
            again = matched(Problem(parts, lambda _: law, np.empty(0)), starts=starts)
            match = min(match, again, key=lambda item: item.squares)
    except FlockanaError as error:
        raise ArgumentError(f"the law cannot be integrated from the recorded starts: {error}") from error
    for segment, residual in zip(parts, match.residuals, strict=True):
        size = np.abs(residual).reshape(len(segment.t), rec.n, rec.m).max(axis=2)
        k, i = np.unravel_index(int(np.argmax(size)), size.shape)
        largest = max(largest, (float(size[k, i]), float(segment.t[k]), int(i)))
    misfit = float(np.sqrt(match.variance))
    most = float(np.sqrt(chi2.isf((1.0 - CONFIDENCE) / 2.0, match.freedom) / match.freedom))
    band = float(norm.isf((1.0 - CONFIDENCE) / 4.0 / rec.q.size))
    size, t, agent = largest
    ratio = max(misfit / most, size / band)
    where = f"worst: {size:.3g} deviations, agent {rec.ids[agent]} at t = {t:.6g}"
    q0, p0 = match.starts[0].reshape(2, rec.n, rec.m)
    status: Literal["met", "unmet", "assumed"] = "met" if ratio <= 1.0 else "unmet"
    text = f"solutions of the law over {duration:.3g} each are off by {misfit:.4g} times the stated noise ({where})"
    if rec.sd is None or rec.estimated:
        status = "assumed"
        text = f"solutions of the law are off by {misfit:.3g} times the noise, which is only estimated ({where})"
    elif ratio > 1.0:
        text += f", where {most:.4g} times, and {band:.3g} deviations at one place, are allowed"
    return Following(status, 1.0 - ratio, text, q0, p0, smooth.p, smooth.accuracy.speed)


def _extended_start(part: Window, matched_start: FloatArray, is_off: bool, law: Any) -> FloatArray:
    """Return a window's initial state, refitted to its first 2, 4, 8, ... samples if the fit is off.

    At an end of the samples splines are worst: a start by them may be too far off to find the solution of all samples.
    """
    start, count = (part.start, 2) if is_off else (matched_start, len(part.t))
    while count < len(part.t):
        first_part = replace(part, t=part.t[:count], y=part.y[:count], root=part.root[:count], start=start)
        start, count = matched(Problem([first_part], lambda _: law, np.empty(0))).starts[0], 2 * count
    return start
