"""Motion of the flock along one of its modes, for pictures and films."""

from math import pi

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_count, ensure_positive
from flockana.dynamics.trajectory import Trajectory
from flockana.stability.linearisation import Linearisation
from flockana.stability.modes import Mode

_SHARE = 0.3  # of the mean distance between agents (a square's side for each): largest displacement
_CREEP = 4.0  # time constants of a mode that does not swing


def mode_motion(
    linearisation: Linearisation,
    mode: Mode,
    *,
    amplitude: float | None = None,
    periods: float = 2.0,
    damped: bool = True,
    samples: int = 121,
) -> Trajectory:
    """Return the linear motion q + Re(a · shape · exp(λt)) of one mode, in the frame of the equilibrium.

    Parameters
    ----------
    linearisation : Linearisation
        Where the mode is from.
    mode : Mode
        Which one; a zero mode is swung to and fro, once per time unit, for it has no time of its own.
    amplitude : float, optional
        Largest displacement of an agent at the start; by default a third of a typical distance between agents, more
        than linear but easy to see.
    periods : float
        How many periods; of a mode that does not swing, in units of four time constants.
    damped : bool
        Let it decay; without, only the swing is shown.
    samples : int
        Number of instants.

    Returns
    -------
    Trajectory
        Its ``u`` is the linear acceleration.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.stability.linearise import linearise
    >>> pair = linearise(Algorithm1(), [[0.0], [7.0]])
    >>> run = mode_motion(pair, pair.modes[0], amplitude=0.5, samples=5)
    >>> run.q[0].ravel().round(12).tolist(), len(run.t)
    ([0.5, 6.5], 5)
    """
    if not isinstance(linearisation, Linearisation):
        raise ArgumentError(f"linearisation = {format_value(linearisation)}: expected what linearise(...) gives")
    if not isinstance(mode, Mode):
        raise ArgumentError(f"mode = {format_value(mode)}: expected one of linearisation.modes")
    q = linearisation.q
    if np.shape(mode.shape) != q.shape:
        raise ArgumentError(f"mode.shape is {np.shape(mode.shape)}: expected {q.shape}, a mode of this linearisation")
    periods, samples = ensure_positive("periods", periods), ensure_count("samples", samples)
    if amplitude is None:
        extent = float(np.ptp(q, axis=0).max())
        scales = linearisation.law.scales
        default_length = scales.length if scales else 1.0  # of one agent, which has no extent
        amplitude = _SHARE * (extent / max(1.0, len(q) ** (1.0 / q.shape[1]) - 1.0) or default_length)
    value = mode.eigenvalue or 2j * pi
    swings = value.imag != 0.0
    duration = 2.0 * pi / abs(value.imag) if swings else _CREEP / abs(value)
    if swings and not damped:
        value = 1j * value.imag
    t = np.linspace(0.0, periods * duration, samples)
    scale = ensure_positive("amplitude", amplitude) / float(np.linalg.norm(np.real(mode.shape), axis=1).max())
    mode_wave = scale * np.exp(value * t)[:, None, None] * mode.shape
    motion_series = (np.ascontiguousarray(np.real(factor * mode_wave)) for factor in (1.0, value, value**2))
    dq, dp, du = motion_series
    return Trajectory(t, q + dq, dp, du, linearisation.law)
