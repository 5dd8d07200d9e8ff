"""Smoothing splines with an error at every sample, for series with gaps.

A spline of degree five that smooths samples of known noise is the mean of a motion whose jerk is white noise, given the
samples; the same computation, a Kalman filter forth and back, gives the variance of position, velocity and acceleration
at each sample. The intensity of the jerk is the largest that the samples nearby do not reject, so that a flock that
settles is smoothed more than one that has just been let go, and an encounter less. Where no curvature of a whole piece
is told from noise, its mean is the straight motion, with the deviations of what the samples allow. Pieces of a series
on both sides of a gap say nothing of each other: what happened in between is not known.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray

_FINEST = 1e-7  # noise, over the spread of a series, below which it counts as exact
_DIFFUSE = 6.0  # deviation of the state before the first sample, over the largest differences of the samples
_JERKS = 12  # intensities that are tried, each a factor of e from the next
_WINDOW = 6  # samples to each side over which a likelihood is local
_DROP = 2.0  # of a log-likelihood that is not rejected: the largest jerk that the samples allow counts

_BENT = 6.0  # of a log-likelihood, by which a motion is told from a straight one
_RESOLVED = 1e-6  # noise over the spread, from which on covariances without jerk are more than rounding
_FEWEST_STRAIGHT = 8  # samples from which on a piece may be straight

_Filtered = tuple[FloatArray, FloatArray, FloatArray]  # means and deviations (T, K, 3), log-likelihoods (T, K)
_Pieces = npt.NDArray[np.intp]


class Smoothed(NamedTuple):
    """Means (T, K, 3) of position, velocity and acceleration, their standard deviations, and the noise."""

    mean: FloatArray
    sd: FloatArray
    noise: float


def smoothed(
    t: FloatArray, y: FloatArray, noise: FloatArray | None, pieces: _Pieces, *, groups: int = 1, floor: float = 0.0
) -> Smoothed:
    """Return the smoothing spline through each gap-free part of each time series, with local jerk intensities.

    `pieces` (T, K) numbers those of each series, -1 outside; an estimated noise is `floor` at least.
    """
    unit = _usual_interval(t, y)
    mean_position = np.nanmean(y, axis=0)
    spread = float(np.nanmax(np.abs(y - mean_position))) or 1.0
    x, clock = (y - mean_position) / spread, (t - t[0]) / unit
    sd = np.maximum(_likeliest_noise(clock, x, pieces), floor / spread) if noise is None else noise / spread
    sd = np.maximum(np.broadcast_to(sd, x.shape), _FINEST)
    jerk, gain = _local_jerk(clock, x, sd, pieces, groups)
    mean, deviations, _ = _filtered(clock, x, sd, jerk, pieces, backwards=True)
    for k, number in np.argwhere(gain.T < _BENT):
        _straighten(clock, x, sd, mean, pieces == number, slice(k * groups, (k + 1) * groups))
    factors = spread * unit ** -np.arange(3.0)
    mean = mean * factors
    mean[:, :, 0] += mean_position
    return Smoothed(mean, deviations * factors, float(sd.max()) * spread)


def _usual_interval(t: FloatArray, y: FloatArray) -> float:
    """Return the median interval between the samples of a series."""
    is_seen = ~np.isnan(y)
    steps = [np.diff(t[is_seen[:, k]]) for k in range(y.shape[1])]
    all_steps = np.concatenate(steps)
    return float(np.median(all_steps)) if all_steps.size else 1.0


def _differences(x: FloatArray, pieces: _Pieces, order: int) -> FloatArray:
    """Return all differences of a given order between successive samples without gaps in time series."""
    rows = []
    for k in range(x.shape[1]):
        known_rows = np.flatnonzero(~np.isnan(x[:, k]))
        piece = pieces[known_rows, k]
        if len(known_rows) > order:
            rows.append(np.diff(x[known_rows, k], order)[piece[order:] == piece[: len(piece) - order]])
    return np.concatenate(rows) if rows else np.empty(0)


def _steepest(x: FloatArray, pieces: _Pieces) -> float:
    """Return the logarithm of an upper bound of the jerk intensity, from third differences of the samples."""
    differences = _differences(x, pieces, 3)
    rms_value = float(np.sqrt(np.mean(differences**2))) if differences.size else 1.0
    return float(np.log(max(rms_value, 1e-14))) + 2.0


def _local_jerk(
    t: FloatArray, x: FloatArray, sd: FloatArray, pieces: _Pieces, groups: int
) -> tuple[FloatArray, FloatArray]:
    """Return the jerk intensity at each sample, (T, K), and the log-likelihood gain by gap-free part, (P, n).

    The first is by the likelihood of the samples nearby.
    """
    top, (count, series) = _steepest(x, pieces), x.shape
    tried = np.maximum(top - np.arange(_JERKS, dtype=np.float64), np.log(sd.min()) - 6.0)
    tried = np.append(tried, -np.inf if sd.min() > _RESOLVED else tried[-1])
    local, piece = np.zeros((len(tried), count, series // groups)), pieces[:, ::groups]
    whole = np.zeros((len(tried), pieces.max() + 2, series // groups))
    for g, jerk in enumerate(tried):
        with np.errstate(over="ignore", invalid="ignore"):  # a jerk whose covariances are rounding is not taken
            variances = _filtered(t, x, sd, np.full((count, series), np.exp(jerk)), pieces, backwards=False)[2]
        variances = np.nan_to_num(
            variances.reshape(count, -1, groups).sum(axis=2), nan=-1e300, neginf=-1e300, posinf=-1e300
        )
        np.add.at(whole[g], (piece, np.arange(series // groups)), variances)
        for by in range(-min(_WINDOW, count - 1), min(_WINDOW, count - 1) + 1):
            here, far_slice = slice(max(-by, 0), count - max(by, 0)), slice(max(by, 0), count - max(-by, 0))
            weight = 1.0 - abs(by) / (_WINDOW + 1.0)
            local[g, here] += weight * np.where(piece[here] == piece[far_slice], variances[far_slice], 0.0)
    is_likely = local[:-1] >= local[:-1].max(axis=0) - _DROP
    largest = tried[np.argmax(is_likely, axis=0)]
    gain = whole.max(axis=0) - whole[-1] if np.isinf(tried[-1]) else np.full(whole.shape[1:], np.inf)
    return np.repeat(np.exp(largest), groups, axis=1), gain[:-1]


def _straighten(t: FloatArray, x: FloatArray, sd: FloatArray, mean: FloatArray, within: Any, axes: slice) -> None:
    """Replace an agent's motion between gaps by a straight one unless acceleration is clearly likelier."""
    is_inside = within[:, axes.start]
    seen = is_inside & ~np.isnan(x[:, axes.start])
    if seen.sum() < _FEWEST_STRAIGHT:
        return
    s = (t - t[seen].mean()) / np.ptp(t[seen])
    forms, weight = np.stack([np.ones_like(s), s, s**2], axis=1), 1.0 / sd[seen, axes.start, None]
    fits = [np.linalg.lstsq(weight * forms[seen, :k], weight * x[seen, axes], rcond=None)[0] for k in (2, 3)]
    costs = [0.5 * np.sum((weight * (x[seen, axes] - forms[seen, : len(c)] @ c)) ** 2) for c in fits]
    if costs[0] - costs[1] < _BENT:
        mean[is_inside, axes, 0] = forms[is_inside, :2] @ fits[0]
        mean[is_inside, axes, 1], mean[is_inside, axes, 2] = fits[0][1] / np.ptp(t[seen]), 0.0


def _likeliest_noise(t: FloatArray, x: FloatArray, pieces: _Pieces) -> FloatArray:
    """Return the noise deviation common to all series, by maximum likelihood with one jerk intensity."""
    from scipy.optimize import minimize

    def cost(z: FloatArray) -> float:
        sd = np.full(x.shape, max(float(np.exp(z[1])), _FINEST))
        return -float(_filtered(t, x, sd, np.full(x.shape, np.exp(z[0])), pieces, backwards=False)[2].sum())

    start = np.array([_steepest(x, pieces) - 4.0, _steepest(x, pieces) - 3.0])
    optimum = minimize(cost, start, method="Nelder-Mead", options={"xatol": 0.02, "fatol": 0.02, "maxfev": 120})
    return np.array(np.exp(optimum.x[1]))


def _filtered(
    t: FloatArray, y: FloatArray, sd: FloatArray, jerk: FloatArray, pieces: _Pieces, *, backwards: bool
) -> _Filtered:
    """Return means, deviations and likelihoods of a Kalman filter, smoothed backwards if requested."""
    count, series = y.shape
    is_seen: npt.NDArray[np.bool_] = ~np.isnan(y)
    alike = all(bool((one == one[:, :1]).all()) for one in (is_seen, sd, jerk, pieces))  # then so are all covariances
    wide = 1 if alike else series
    begins = (pieces >= 0) & (pieces != np.vstack([np.full((1, series), -2), pieces[:-1]]))
    unknown = np.broadcast_to(np.diag(_initial_variance(y, sd, pieces)), (wide, 3, 3))
    state, cov = np.zeros((series, 3)), unknown
    means, covs = np.empty((count, series, 3)), np.empty((count, wide, 3, 3))
    before, cov_before = np.empty_like(means), np.empty_like(covs)
    likelihood, use, variance = np.zeros((count, series)), is_seen[:, :wide], sd[:, :wide] ** 2
    turns, kicks = zip(*(_transition(h) for h in np.diff(t, prepend=t[0]).tolist()), strict=True)
    for k in range(count):
        if k:
            state, cov = state @ turns[k].T, turns[k] @ cov @ turns[k].T + jerk[k, :wide, None, None] ** 2 * kicks[k]
            state = np.where(begins[k][:, None], 0.0, state)
            cov = np.where(begins[k, :wide, None, None], unknown, cov)
        before[k], cov_before[k] = state, cov
        if use[k].any():
            size = np.maximum(cov[:, 0, 0], 0.0) + variance[k]
            gain = np.where(use[k][:, None], cov[:, :, 0] / size[:, None], 0.0)
            off = np.where(is_seen[k], np.nan_to_num(y[k]) - state[:, 0], 0.0)
            likelihood[k] = -0.5 * (off**2 / size + np.log(size)) * is_seen[k]
            state = state + gain * off[:, None]
            keep = np.broadcast_to(np.eye(3), (wide, 3, 3)).copy()
            keep[:, :, 0] -= gain
            noise = (variance[k] * use[k])[:, None, None] * gain[:, :, None] * gain[:, None, :]
            cov = keep @ cov @ keep.swapaxes(1, 2) + noise
            cov = 0.5 * (cov + cov.swapaxes(1, 2))
        means[k], covs[k] = state, cov
    for k in range(count - 2 if backwards else -1, -1, -1):
        way = np.linalg.solve(cov_before[k + 1], turns[k + 1] @ covs[k]).swapaxes(1, 2)
        way = np.where(begins[k + 1, :wide, None, None], 0.0, way)  # the next piece says nothing of this one
        means[k] += np.einsum("kij,kj->ki", np.broadcast_to(way, (series, 3, 3)), means[k + 1] - before[k + 1])
        covs[k] += way @ (covs[k + 1] - cov_before[k + 1]) @ way.swapaxes(1, 2)
    deviations = np.sqrt(np.maximum(np.diagonal(covs, axis1=2, axis2=3), 0.0))
    return means, np.broadcast_to(deviations, means.shape).copy(), likelihood


def _initial_variance(y: FloatArray, sd: FloatArray, pieces: _Pieces) -> FloatArray:
    """Return variances of position, velocity and acceleration before the first sample."""
    magnitudes = [np.abs(_differences(y, pieces, k)) if k else np.abs(y[~np.isnan(y)]) for k in range(3)]
    largest = np.array([float(x.max()) if x.size else 1.0 for x in magnitudes])
    return (_DIFFUSE * (largest + float(sd.max()))) ** 2


def _transition(h: float) -> tuple[FloatArray, FloatArray]:
    """Return transition matrix and noise covariance of (position, velocity, acceleration) for unit white jerk."""
    transition = np.array([[1.0, h, 0.5 * h * h], [0.0, 1.0, h], [0.0, 0.0, 1.0]])
    kick = np.array(
        [[h**5 / 20.0, h**4 / 8.0, h**3 / 6.0], [h**4 / 8.0, h**3 / 3.0, h**2 / 2.0], [h**3 / 6.0, h**2 / 2.0, h]]
    )
    return transition, kick
