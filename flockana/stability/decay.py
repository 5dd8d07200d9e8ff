"""Comparison of predicted decay rates and paths with nonlinear runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil, inf, log, pi
from typing import Any

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_positive
from flockana.base.vector_norms import lengths
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.measures.centre_frame import moving_frame
from flockana.measures.nets import links
from flockana.stability.linearisation import Linearisation
from flockana.stability.modes import Mode
from flockana.stability.motion_of_mode import mode_motion

AMPLITUDE = 1e-4  # of d: the first neglected term is as small, relative to the linear one
_FALL = 1e8  # by which K̃ has fallen when the run ends
_LATE = 0.6  # of a random start's run that is left out: what is fast has decayed
_SAMPLES = 24  # per half period
_FEWEST, _MOST = 6, 4000  # half periods
_FLOOR = 1e-12  # of the largest K̃: below that, velocities are lost in the errors of the run
_SEEN = 0.1  # share of a mode that is no translation, from which on K̃ sees it
_RTOL = 1e-11  # and 1e-13 of the law's speed, of which 1e-8 is left at the end; tighter, rounding of forces stalls it
_SMALL = 3e-3  # deviation up to which the exponent is fitted


@dataclass(frozen=True, eq=False)
class Decay:
    """Decay rates of one small perturbation, predicted and measured.

    Parameters
    ----------
    name, law : str
        Of the equilibrium, and of its law.
    mode : Mode
        The slowest mode that K̃ sees.
    predicted, measured : float
        Decay rate: of the mode, and −½ of the slope of log K̃(t), per time unit.
    error : float
        Standard deviation of the slope along the run, as a rate.
    random_linear, random_measured : float
        Likewise from a random start, late in its run: of the linear system, which has not quite reached the slowest
        mode there, and of the run.
    t, mismatch : ndarray, shape (T,)
        K̃ over time, from the start along the mode.
    """

    name: str
    law: str
    n: int
    m: int
    mode: Mode = field(repr=False)
    predicted: float
    measured: float
    error: float
    random_linear: float
    random_measured: float
    t: FloatArray = field(repr=False)
    mismatch: FloatArray = field(repr=False)

    @property
    def difference(self) -> float:
        """Relative difference of the measured rate from the predicted one."""
        return abs(self.measured / self.predicted - 1.0)

    @property
    def random_difference(self) -> float:
        """Relative difference between the decay rate measured from a random start and the linear one."""
        return abs(self.random_measured / self.random_linear - 1.0)


def slowest_seen(flock: Linearisation) -> Mode:
    """Return the slowest mode visible in velocities relative to the centre of mass."""
    for mode in flock.modes:
        if float(np.linalg.norm(mode.shape - mode.shape.mean(axis=0))) >= _SEEN:
            if mode.decays:
                return mode
            raise ArgumentError(
                f"mode {mode.name} has decay rate {mode.decay_rate:.3g}, where rounding alone may make "
                f"{mode.error:.1g}: expected a stable flock"
            )
    raise ArgumentError(f"n = {len(flock.q)}: expected a mode of the shape; this flock has none")


@check_kinds
def decay(flock: Linearisation, *, name: str = "", seed: int = 0) -> Decay:
    """Run the nonlinear flock from a small perturbation along its slowest mode, and from a random one."""
    # K̃ falls as exp(−2 σ t), times a function of the mode's half period. The slope is therefore that of sums over half
    # periods, and exact for a pure mode.
    mode = slowest_seen(flock)
    size = AMPLITUDE * _length(flock)
    half = pi / mode.frequency if mode.frequency else 1.0 / mode.decay_rate
    count = max(_FEWEST, ceil(log(_FALL) / (2.0 * mode.decay_rate * half)))
    if count > _MOST:
        raise ArgumentError(
            f"mode {mode.name} swings {count / 2:.3g} times until K̃ has fallen by {_FALL:g} (damping ratio "
            f"{mode.damping_ratio:.2g}): expected at most {_MOST // 2} times; take more damping"
        )
    t = np.linspace(0.0, count * half, count * _SAMPLES + 1)
    start = mode_motion(flock, mode, amplitude=size, samples=2)
    mismatch = velocity_mismatch(_run(flock, start.q[0] - flock.q, start.p[0], t)[1])
    slopes = logarithmic_slopes(mismatch, half)[: _count_above_floor(mismatch)]
    rng = np.random.default_rng(seed)
    dq = moving_frame(rng.standard_normal(flock.q.shape))
    dq *= size / float(np.linalg.norm(dq, axis=1).max())
    mismatches = [velocity_mismatch(item(flock, dq, 0.0 * dq, t)[1]) for item in (linear_motion, _run)]
    count_above = _count_above_floor(mismatches[0])
    late_slice = slice(int(_LATE * count_above), count_above)
    if not slopes.size or late_slice.start == late_slice.stop:
        raise ArgumentError(
            f"mode {mode.name} is damped so much (ratio {mode.damping_ratio:.4g}) that K̃ is lost in the errors of a "
            "run within half a swing: expected less damping"
        )
    late_linear, late_measured = (float(-0.5 * logarithmic_slopes(x, half)[late_slice].mean()) for x in mismatches)
    measured_value, error = -0.5 * float(slopes.mean()), 0.5 * float(slopes.std())
    law, rate, (n, m) = type(flock.law).__name__, mode.decay_rate, flock.q.shape
    return Decay(name or law, law, n, m, mode, rate, measured_value, error, late_linear, late_measured, t, mismatch)


@check_kinds
def decay_table(flocks: Mapping[str, Linearisation]) -> tuple[Decay, ...]:
    """Return predicted and measured decay rates of several flocks as a table (`decay`).

    Parameters
    ----------
    flocks : mapping of str to Linearisation
        By name.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.stability.linearise import linearise
    >>> [row.name for row in decay_table({"pair": linearise(Algorithm1(), [[0.0], [7.0]])})]
    ['pair']
    """
    return tuple(decay(flock, name=name) for name, flock in flocks.items())


@dataclass(frozen=True, eq=False)
class LinearRange:
    """Range of validity of the linear prediction of the slowest mode.

    Parameters
    ----------
    amplitudes : ndarray, shape (K,)
        Largest initial displacement of an agent, in units of d.
    deviations : ndarray, shape (K,)
        Largest distance ever between an agent and its linear prediction, over the initial displacement.
    net_changes : ndarray of bool, shape (K,)
        Whether a link forms or breaks on the way.
    margin : float
        Amplitude at which, to first order, the first link reaches r, forming or breaking; infinite if none can.
    """

    name: str
    amplitudes: FloatArray
    deviations: FloatArray
    net_changes: Any
    margin: float

    @property
    def exponent(self) -> float:
        """Slope of log(deviation × amplitude) against log(amplitude) where the deviation is below 0.003.

        2 where the first neglected term of the force is quadratic, as it is where V is three times differentiable.
        """
        return self._fit[0]

    @property
    def exponent_error(self) -> float:
        """Standard error of `exponent`; infinite with two points."""
        return self._fit[1]

    @property
    def _fit(self) -> tuple[float, float]:
        small = self.deviations < _SMALL
        if small.sum() < 2:
            return float("nan"), inf
        from scipy.stats import linregress

        fit: Any = linregress(np.log(self.amplitudes[small]), np.log(self.amplitudes[small] * self.deviations[small]))
        return float(fit.slope), float(fit.stderr) if small.sum() > 2 else inf

    def limit(self, deviation: float) -> float:
        """Return the largest amplitude, in units of d, at which linear prediction errs by less than a share.

        Parameters
        ----------
        deviation : float
            Share of the initial displacement, such as 0.1.
        """
        exceeding_rows = np.flatnonzero(self.deviations > ensure_positive("deviation", deviation))
        if not exceeding_rows.size:
            return float(self.amplitudes[-1])
        k = int(exceeding_rows[0])
        if k == 0:
            return 0.0
        pair = slice(k - 1, k + 1)
        return float(np.exp(np.interp(log(deviation), np.log(self.deviations[pair]), np.log(self.amplitudes[pair]))))


@check_kinds
def linear_range(
    flock: Linearisation, *, name: str = "", amplitudes: Sequence[float] = tuple(np.geomspace(1e-4, 0.3, 15).tolist())
) -> LinearRange:
    """Compare nonlinear runs from growing perturbations along the slowest mode with its linear motion.

    Parameters
    ----------
    flock : Linearisation
        The linearised flock.
    amplitudes : sequence of float
        Largest displacements, in units of d, rising.

    Raises
    ------
    ArgumentError
        If they do not rise, or nothing decays.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.stability.linearise import linearise
    >>> flock = linear_range(linearise(Algorithm1(), [[0.0], [7.0]]), amplitudes=[1e-4, 2e-4])
    >>> round(flock.exponent, 1)
    2.0
    """
    levels = np.array([ensure_positive("amplitudes", x) for x in amplitudes])
    if levels.size == 0 or np.any(np.diff(levels) <= 0.0):
        raise ArgumentError(f"amplitudes = {amplitudes!r}: expected rising numbers")
    mode, pair = slowest_seen(flock), flock.law.pair
    reach = inf if pair is None else pair.range
    deviations, changes = [], []
    for start_amplitude in (levels * _length(flock)).tolist():
        line = mode_motion(flock, mode, amplitude=start_amplitude, periods=1.0 + 3.0 * bool(mode.frequency), samples=97)
        q, _ = _run(flock, line.q[0] - flock.q, line.p[0], line.t)
        drift = q - line.q
        if flock.law.centre_decouples and flock.second_order.split.exact:  # the centre of mass moves by itself
            drift = drift - drift.mean(axis=1, keepdims=True)
        deviations.append(float(lengths(drift).max()) / start_amplitude)
        changes.append(len({links(x, reach).tobytes() for x in q}) > 1 if np.isfinite(reach) else False)
    name = name or type(flock.law).__name__
    return LinearRange(name, levels, np.array(deviations), np.array(changes), _margin(flock, mode, reach))


def _length(flock: Linearisation) -> float:
    """Return the law's own length d, else the size of the flock."""
    scales = flock.law.scales
    return scales.length if scales else float(np.linalg.norm(flock.q - flock.q.mean(axis=0), axis=1).max()) or 1.0


def _run(flock: Linearisation, dq: FloatArray, dp: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities of the nonlinear flock, in the frame of the equilibrium."""
    times = flock.t + t
    span = float(times[0]), float(times[-1])
    start = flock.q + dq, flock.p + dp
    run = ensure_uninterrupted(simulate(flock.law, *start, span, t_eval=times, rtol=_RTOL))
    return run.q - t[:, None, None] * flock.p, run.p - flock.p


def linear_motion(flock: Linearisation, dq: FloatArray, dp: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return δq, δp of the linear flock at equally spaced times."""
    from scipy.linalg import expm

    step, state = expm(flock.A * (t[1] - t[0])), np.concatenate([dq.ravel(), dp.ravel()])
    states = np.empty((t.size, state.size))
    for k in range(t.size):
        states[k], state = state, step @ state
    split_states = states.reshape(t.size, 2, *dq.shape)
    return split_states[:, 0], split_states[:, 1]


def velocity_mismatch(p: FloatArray) -> FloatArray:
    """Return half the sum of squared velocity deviations from the mean, ½ Σ‖p_i − p_c‖², at every sample."""
    relative = p - p.mean(axis=1, keepdims=True)
    return 0.5 * np.sum(relative**2, axis=(1, 2))


def logarithmic_slopes(mismatch: FloatArray, half: float) -> FloatArray:
    """Return logarithmic rates of change of the velocity mismatch, from sums over consecutive half periods."""
    sums = np.convolve(mismatch, np.ones(_SAMPLES), mode="valid")
    with np.errstate(divide="ignore", invalid="ignore"):  # where all has come to rest there is no slope
        slopes: FloatArray = np.log(sums[_SAMPLES:] / sums[:-_SAMPLES]) / half
    return slopes


def _count_above_floor(mismatch: FloatArray) -> int:
    """Return the number of logarithmic slopes before the velocity mismatch falls below a relative floor."""
    sums = np.convolve(mismatch, np.ones(_SAMPLES), mode="valid")[_SAMPLES:]
    return int(np.argmin(np.append(sums > _FLOOR * _SAMPLES * mismatch.max(), False)))


def _margin(flock: Linearisation, mode: Mode, reach: float) -> float:
    """Return the mode amplitude, in units of d, at which the first pair reaches the range r, to first order."""
    if not np.isfinite(reach):
        return inf
    i, j = np.triu_indices(len(flock.q), 1)
    delta = flock.q[j] - flock.q[i]
    distance = np.linalg.norm(delta, axis=1)
    shape = mode.shape / float(np.linalg.norm(np.real(mode.shape), axis=1).max())
    rate = np.abs(np.einsum("kc,kc->k", delta / distance[:, None], shape[j] - shape[i]))
    moving = rate > 1e-9
    return float((np.abs(distance - reach)[moving] / rate[moving]).min(initial=inf)) / _length(flock)
