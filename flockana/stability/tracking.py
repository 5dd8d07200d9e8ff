"""Tracking of a γ-agent by the centre of mass in a run, against the closed form of `centre_path`."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ComplexArray, FloatArray
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import CircleTarget, SineTarget
from flockana.laws import Algorithm2
from flockana.stability.centre_path import Motion, centre_path, motion, path_and_factor, steady_error, transient
from flockana.stability.centre_transfer import CentreOfMass, map_gain

_SAMPLES, _APART = 8, 1e-2  # least number of samples of a fit of four unknowns, and least ratio of its singular values
_WHOLE = 1e-9  # relative: a run that is as long as a period but for rounding is as long as a period


def _amplitude(t: FloatArray, x: FloatArray, omega: float) -> tuple[ComplexArray, float]:
    """Return the complex amplitude of a series at frequency ω and its error, by least squares."""
    # The error is infinite where there are hardly more samples than unknowns, or where they cannot tell these apart.
    centred_time = (t - t.mean()) / max(float(np.ptp(t)), float(np.finfo(np.float64).tiny))
    basis = np.column_stack([np.cos(omega * t), np.sin(omega * t), np.ones_like(t), centred_time])
    fit, _, _, singular_values = np.linalg.lstsq(basis, x, rcond=None)
    residual = x - basis @ fit
    is_decaying = t.size >= _SAMPLES and singular_values[-1] > _APART * singular_values[0]
    error = float(np.sqrt(np.mean(np.sum(residual**2, axis=1)))) if is_decaying else inf
    return fit[0] - 1j * fit[1], error


def _swings(run: Trajectory) -> tuple[ComplexArray, ComplexArray, float]:
    """Return oscillation amplitudes of flock and γ-agent over the last whole periods, and the fit error."""
    path, _ = path_and_factor(run.law.target)
    if not isinstance(path, SineTarget | CircleTarget):
        raise ArgumentError(f"target = {path!r}: expected a SineTarget or a CircleTarget")
    if not whole_period(run, path):
        duration = float(run.t[-1] - run.t[0])
        raise ArgumentError(f"the run lasts {duration:g}: expected at least one period, {1.0 / path.frequency:g}")
    cycle_count = max(1, int((1.0 + _WHOLE) * 0.5 * float(run.t[-1] - run.t[0]) * path.frequency))
    window = run.window(run.t[-1] - cycle_count / path.frequency, run.t[-1])
    omega = 2.0 * pi * path.frequency
    flock, error = _amplitude(window.t, window.q.mean(axis=1), omega)
    agent, _ = _amplitude(window.t, np.array([path.position(t) for t in window.t]), omega)
    false_amplitude, _ = _amplitude(window.t, _transient(run, window.t), omega)
    return flock, agent, error + float(np.linalg.norm(false_amplitude))


def whole_period(run: Trajectory, path: SineTarget | CircleTarget) -> bool:
    """Return whether a run lasts at least one period of its γ-agent."""
    return bool(float(run.t[-1] - run.t[0]) * path.frequency >= 1.0 - _WHOLE)


def _transient(run: Trajectory, t: FloatArray) -> FloatArray:
    """Return the remaining transient of the centre of mass at given times; for a map, that of its flow."""
    # Without a pull the place that the centre ends at is arbitrary, and no part of the fit.
    moving, gains = motion(run.law.target), run.law.gains
    start, position, speed = float(run.t[0]), run.q[0].mean(axis=0), run.p[0].mean(axis=0)
    if gains.c1_gamma > 0.0:
        return transient(gains, moving, t, start, position, speed)
    swing = CentreOfMass(gains, moving.factor).response(moving.omega) * moving.swing
    slip = speed - moving.drift - (1j * moving.omega * swing * np.exp(1j * moving.omega * start)).real
    elapsed_time, drag = (t - start)[:, None], gains.c2_gamma
    return -np.exp(-drag * elapsed_time) * slip / drag if drag > 0.0 else 0.0 * elapsed_time * slip


@check_kinds
def response_ratio(run: Trajectory) -> tuple[float, float]:
    """Return the ratio of the centre's oscillation to the γ-agent's over the last whole periods, and its error.

    At most half of the run is used, but at least one period: what precedes is transient. The error is the root mean
    square of what the fit leaves over, and the swing that what is left of the start would feign by itself, relative to
    the γ-agent's amplitude.

    Parameters
    ----------
    run : Trajectory
        A run whose law has a sine or circle as its target.

    Raises
    ------
    ArgumentError
        If the law has no such target, or the run is shorter than one period.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana import CircleTarget, Gains, StaticTarget
    >>> law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=4.0), target=CircleTarget((0.0, 0.0), 1.0, 0.25))
    >>> ratio, error = response_ratio(simulate(law, [[1.0, 0.0]], [[0.0, 0.0]], (0.0, 30.0)))
    >>> bool(abs(ratio - abs(CentreOfMass(law.gains).response(0.5 * pi))) < 1e-6)
    True
    """
    flock, agent, error = _swings(run)
    magnitude = float(np.linalg.norm(agent))
    return float(np.linalg.norm(flock)) / magnitude, error / magnitude


@dataclass(frozen=True)
class Quantity:
    """Quantity with its predicted and its measured value, in a comparison with theory.

    Parameters
    ----------
    name : str
        What it is, with its unit.
    predicted, measured : float
        The two values.
    error : float
        Uncertainty of the measured one.
    """

    name: str
    predicted: float
    measured: float
    error: float = 0.0


@dataclass(frozen=True)
class Tracking:
    """Tracking of a γ-agent by the centre of mass, predicted and measured.

    Parameters
    ----------
    centre : CentreOfMass
        The linear system, with the factor of the γ-agent's p_r.
    quantities : tuple of Quantity
        Predictions and measurements.
    """

    centre: CentreOfMass
    quantities: tuple[Quantity, ...]

    def quantity(self, name: str) -> Quantity:
        """Return the compared quantity whose name begins with a given text."""
        return next(item for item in self.quantities if item.name.startswith(name))

    def __str__(self) -> str:
        """Return the comparison as text, a line for each quantity: name, predicted, measured."""
        width = max((len(item.name) for item in self.quantities), default=0)
        return "\n".join(
            f"{item.name:<{width}}  predicted {item.predicted:10.6g}  measured {item.measured:10.6g}"
            for item in self.quantities
        )


def tracking(run: Trajectory) -> Tracking:
    """Compare a run of Algorithm 2, or of the MSN project's map, with the linear system of its centre of mass.

    Ratio and phase for a sine or circle, the lag on a line, the turning points and the period where an underdamped
    flock swings about a target at rest, and under the continuous law the whole path.

    Parameters
    ----------
    run : Trajectory
        A run of Algorithm 2, or of its map, with a static, linear, sine or circle target.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana import CircleTarget, Gains, StaticTarget
    >>> law = Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=0.0), target=StaticTarget((5.0,)))
    >>> quantities = tracking(simulate(law, [[1.0]], [[0.0]], (0.0, 7.0)))
    >>> [round(x, 4) for x in (quantities.quantity("period").predicted, quantities.quantity("period").measured)]
    [6.2832, 6.2832]
    """
    law = ensure_run(run, "run").law
    if (type(law) is not Algorithm2 and law.centre_system() is None) or law.target is None:
        raise ArgumentError(f"{type(law).__name__}: expected a run of Algorithm 2 or of the MSN project's map of it")
    moving = motion(law.target)
    centre = CentreOfMass(law.gains, moving.factor)
    quantities: list[Quantity] = []
    if type(law) is Algorithm2:
        q_c = run.q.mean(axis=1)
        path = centre_path(law.gains, law.target, run.t, q_c[0], run.p[0].mean(axis=0))
        quantities.append(Quantity("path, largest deviation (length)", 0.0, float(np.abs(q_c - path).max())))
    if moving.swing.any():
        quantities += _ratio(run, centre, moving)
    elif moving.velocity.any():
        lag = np.linalg.norm(run.q[-1].mean(axis=0) - law.target.position(float(run.t[-1])))
        quantities.append(Quantity("lag (length)", steady_error(law.gains, law.target)[0], float(lag)))
    elif type(law) is Algorithm2 and np.isfinite(centre.period):
        quantities += _swing(run, centre)
    return Tracking(centre, tuple(quantities))


def _ratio(run: Trajectory, centre: CentreOfMass, moving: Motion) -> list[Quantity]:
    flock, agent, error = _swings(run)
    magnitude = float(np.linalg.norm(agent))
    is_discrete = run.law.centre_system() is not None
    gain = map_gain(run.law, moving.omega, factor=moving.factor) if is_discrete else abs(centre.response(moving.omega))
    ratio = Quantity("ratio of sizes", float(gain), float(np.linalg.norm(flock)) / magnitude, error / magnitude)
    if is_discrete:
        return [ratio]
    phase = float(np.degrees(np.angle(np.vdot(agent, flock))))
    predicted_value = float(np.degrees(np.angle(centre.response(moving.omega))))
    return [ratio, Quantity("phase (degrees)", predicted_value, phase, float(np.degrees(error / magnitude)))]


def _swing(run: Trajectory, centre: CentreOfMass) -> list[Quantity]:
    """Return the compared period and first turning point of the centre of mass; empty without two turns."""
    from scipy.interpolate import BPoly, PPoly

    t, *states, _ = run.path  # its own steps too: samples of one's own choice may miss a turn
    x, v, a = (series.mean(axis=1) for series in states)
    x = x - run.law.target.position(0.0)
    axis = x[0] / (float(np.linalg.norm(x[0])) or 1.0)
    speed = v @ axis
    place = PPoly.from_bernstein_basis(BPoly.from_derivatives(t, np.column_stack([x @ axis, speed, a @ axis])))
    turns = place.derivative().roots(extrapolate=False)
    if abs(speed[0]) <= 1e-12 * float(np.abs(speed).max()):  # at rest at the start: a root, found or not by rounding
        turns = np.append(t[0], turns[turns > t[0] + 0.5 * (t[1] - t[0])])
    if turns.size < 2 or not np.isfinite(turns).all():
        return []
    period, damping = 2.0 * float(np.mean(np.diff(turns))), 0.5 * centre.gains.c2_gamma
    farthest = -float(place(turns[0])) * float(np.exp(-damping * 0.5 * centre.period))
    return [
        Quantity("period (time)", centre.period, period),
        Quantity("first turning point beyond the target (length)", farthest, float(place(turns[1]))),
    ]
