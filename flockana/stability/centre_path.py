"""The centre of mass behind a γ-agent on a line, a sine or a circle, in closed form."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ComplexArray, FloatArray, ensure_vector
from flockana.environment import RescaledVelocity, Target
from flockana.interactions import Gains
from flockana.laws import ensure_one_gain
from flockana.stability.centre_transfer import CentreOfMass

_SHORT = 1e-8  # of Δt²: the series' next term is its square over 120


def path_and_factor(target: Target | None) -> tuple[Target | None, float]:
    """Return the γ-agent's path without its velocity rescaling, and the factor by which p_r is rescaled."""
    return (target.target, target.factor) if isinstance(target, RescaledVelocity) else (target, 1.0)


@dataclass(frozen=True)
class Motion:
    """q_r(t) = start + velocity t + Re(swing e^jωt) and p_r(t) = drift + factor Re(jω swing e^jωt)."""

    # start, velocity, drift: shape (m,): where it is at t = 0 but for the swing, how fast it travels, and what it says
    # about that
    start: FloatArray
    velocity: FloatArray
    drift: FloatArray
    swing: ComplexArray  # shape (m,): amplitudes
    omega: float  # angular frequency, 0 without a swing
    factor: float  # p_r over dq_r/dt, of the swing


def motion(target: Target) -> Motion:
    """Return a γ-agent's motion as a line plus a harmonic."""
    path = target.closed_path if isinstance(target, Target) else None
    if path is None:
        raise ArgumentError(f"target = {target!r}: expected a static, linear, sine or circle target")
    start, velocity, cosine, sine, constant = path.terms
    return Motion(start, velocity, path.factor * velocity + constant, cosine - 1j * sine, path.omega, path.factor)


def steady_motion(gains: Gains, moving: Motion) -> tuple[FloatArray, ComplexArray]:
    """Return the constant lag and the oscillation amplitude of the centre of mass after the transient."""
    ensure_one_gain(gains)
    c1, c2 = gains.c1_gamma, gains.c2_gamma
    if c1 == 0.0:
        raise ArgumentError("c1_gamma = 0: expected a pull > 0; without one the centre of mass follows no position")
    if c2 == 0.0 and moving.swing.any() and abs(moving.omega**2 - c1) <= 1e-12 * c1:
        raise ArgumentError(
            f"c2_gamma = 0 and the γ-agent swings at √c1γ = {moving.omega:g}: resonance, no steady state"
        )
    lag: FloatArray = c2 * (moving.velocity - moving.drift) / c1
    return lag, CentreOfMass(gains, moving.factor).response(moving.omega) * moving.swing


def steady_error(gains: Gains, target: Target) -> tuple[float, float]:
    """Return the steady errors sup ‖q_c − q_r‖ from the line and from the oscillation of the γ-agent.

    On a line the centre lags by c2γ ‖v − p_r‖/c1γ, by nothing if p_r is the true velocity; on a sine or circle of
    size A by |G(jω) − 1| A.

    Parameters
    ----------
    gains : Gains
        c1γ and c2γ are used.
    target : Target
        Static, on a line, a sine or a circle.

    Raises
    ------
    ArgumentError
        On another target, without a pull, or in resonance.

    Examples
    --------
    >>> from flockana.environment.targets import LinearTarget
    >>> hidden = RescaledVelocity(LinearTarget((0.0, 0.0), (3.0, 0.0)), 0.0)
    >>> steady_error(Gains(c1_gamma=2.0, c2_gamma=4.0), hidden)
    (6.0, 0.0)
    """
    moving = motion(target)
    lag, swing = steady_motion(gains, moving)
    off = swing - moving.swing
    # the longest semi-axis of the ellipse Re(off e^jωt)
    squared_value = 0.5 * (float(np.vdot(off, off).real) + abs(complex(off @ off)))
    return float(np.linalg.norm(lag)), float(np.sqrt(squared_value))


def centre_path(gains: Gains, target: Target, t: Any, q_c: Any, p_c: Any) -> FloatArray:
    """Return q_c(t) in closed form from its start at t[0], transient included, shape (T, m)."""
    moving, times = motion(target), np.atleast_1d(np.asarray(t, dtype=np.float64))
    start, speed = ensure_vector("q_c", q_c, moving.start.size), ensure_vector("p_c", p_c, moving.start.size)
    lag, swing = steady_motion(gains, moving)
    phase_factors = np.exp(1j * moving.omega * times)[:, None]
    steady_state = moving.start + moving.velocity * times[:, None] - lag + (swing * phase_factors).real
    return steady_state + transient(gains, moving, times, float(times[0]), start, speed)


def transient(
    gains: Gains, moving: Motion, t: FloatArray, start: float, q_c: FloatArray, p_c: FloatArray
) -> FloatArray:
    """Return the transient at times t from the initial offset and velocity error of the centre, shape (T, m)."""
    lag, swing = steady_motion(gains, moving)
    phase_factors = np.exp(1j * moving.omega * start)
    steady_state = moving.start + moving.velocity * start - lag + (swing * phase_factors).real
    rate = moving.velocity + (1j * moving.omega * swing * phase_factors).real
    return _decayed(gains, t - start, q_c - steady_state, p_c - rate)


def _decayed(gains: Gains, since: FloatArray, left: FloatArray, velocity: FloatArray) -> FloatArray:
    """Return the solution of x'' = −c1γ x − c2γ x' from an initial offset and velocity, shape (T, m)."""
    since = since[:, None]
    decay, radicand = 0.5 * gains.c2_gamma, CentreOfMass(gains).discriminant
    root = np.sqrt(complex(radicand))
    # e^At of the companion matrix: cosh and sinh(√Δ t)/√Δ, real whatever the sign of Δ; decay ≥ Re √Δ, so no overflow
    rise, fast_decay = np.exp((root - decay) * since), np.exp((-root - decay) * since)
    level = 0.5 * (rise + fast_decay).real
    short = np.abs(radicand) * since**2 < _SHORT  # where rise and fall cancel: sinh x/x by its series
    series = since * np.exp(-decay * since) * (1.0 + radicand * since**2 / 6.0)
    slope = np.where(short, series, ((rise - fast_decay) / (2.0 * (root or 1.0))).real)
    return left * level + (velocity + decay * left) * slope
