"""Gain at which one mode of a flock reaches a given damping ratio, with the mode and equilibrium followed."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError, SolverError
from flockana.base.value_checks import FloatArray, ensure_count, ensure_known, ensure_points, ensure_positive
from flockana.equilibria.solve import find_equilibrium
from flockana.stability.linearisation import Linearisation
from flockana.stability.linearise import linearise
from flockana.stability.modes import Mode

_WIDE = 100.0  # up and down from the law's own gain
_EXACT = 1e-10  # of a gain


class DampedGain(NamedTuple):
    """Gain, law and mode with the required damping ratio."""

    gain: float
    law: Any
    mode: Mode


class _Here(NamedTuple):
    """Followed mode at one value of the gain, with the linearisation about its equilibrium."""

    linear: Linearisation
    mode: Mode


def gain_for_damping(
    law: Any,
    q: Any,
    name: str,
    ratio: float,
    *,
    mode: str | None = None,
    between: tuple[float, float] | None = None,
    steps: int = 40,
) -> DampedGain:
    """Return the gain nearest to the law's own at which one mode has a given damping ratio.

    The mode is followed from the law's own gain, up and down in steps of one ratio: in each it is the one whose
    eigenvalue and shape change least. The equilibrium is found anew from the last.

    Parameters
    ----------
    law : Law
        With `gains`, the named one positive and one for all agents.
    q : Equilibrium or array_like, shape (n, m)
        Equilibrium, or positions near it.
    name : str
        Of the gain, as ``"c2_alpha"``.
    ratio : float
        ζ = −Re λ/|λ|, between 0 and 1.
    mode : str, optional
        Name of the mode at the law's own gain, as `linearise` has it; by default the slowest that swings.
    between : (float, float), optional
        Least and greatest gain; by default a hundredth and a hundred times the law's own.
    steps : int
        Values between one end and the other.

    Raises
    ------
    SolverError
        If the mode has that ratio at no gain in between; the ratios met are named.

    Examples
    --------
    A lone agent held by s² + c2γ s + c1γ is damped by 0.5 at c2γ = √c1γ:

    >>> from flockana import Algorithm2, Gains, StaticTarget
    >>> law = Algorithm2(target=StaticTarget((0.0,)), gains=Gains(c1_gamma=4.0, c2_gamma=1.0))
    >>> round(gain_for_damping(law, [[0.0]], "c2_gamma", 0.5).gain, 9)
    2.0
    """
    gain_names = tuple(key for key in vars(getattr(law, "gains", None) or object) if key.startswith("c"))
    if not gain_names:
        raise ArgumentError(f"{type(law).__name__} has no gains: expected a law with gains, such as Algorithm2(...)")
    ensure_known("gain", name, gain_names)
    wanted_ratio = ensure_positive("ratio", ratio)
    if wanted_ratio >= 1.0:
        raise ArgumentError(f"ratio = {ratio:g}: expected a damping ratio below 1; from 1 on a mode does not swing")
    own_gain = ensure_positive(f"law.gains.{name}", getattr(law.gains, name))
    low, high = (ensure_positive("between", each) for each in between or (own_gain / _WIDE, own_gain * _WIDE))
    if not low <= own_gain <= high:
        raise ArgumentError(f"between = ({low:g}, {high:g}): expected to hold the law's own {name} = {own_gain:g}")
    start = _begin(law, ensure_points("q", getattr(q, "q", q)), mode)
    count = ensure_count("steps", steps)
    crossings, ratios = [], [start.mode.damping_ratio]
    for end in (low, high):
        gain, tracked = own_gain, start
        share = np.log(end / own_gain) / np.log(high / low)
        for level in np.geomspace(own_gain, end, 1 + int(np.ceil(count * abs(share))))[1:].tolist():
            continued = _follow(_with(law, name, level), tracked)
            ratios.append(continued.mode.damping_ratio)
            if (tracked.mode.damping_ratio - wanted_ratio) * (continued.mode.damping_ratio - wanted_ratio) <= 0.0:
                crossings.append((gain, level, tracked))
                break
            gain, tracked = level, continued
    if not crossings:
        raise SolverError(
            f"mode {start.mode.name} has ζ = {min(ratios):.4g} to {max(ratios):.4g} at {name} = {low:g} to {high:g}: "
            f"expected {wanted_ratio:g} among them; ask for another mode, gain or range"
        )
    first_gain, second_gain, tracked = min(crossings, key=lambda each: abs(np.log(each[0] / own_gain)))
    return _refine(law, name, wanted_ratio, (first_gain, second_gain), tracked)


def _with(law: Any, name: str, gain: float) -> Any:
    return replace(law, gains=replace(law.gains, **{name: gain}))


def _linearised(law: Any, q: FloatArray) -> Linearisation:
    """Return the linearisation about the equilibrium near some positions."""
    equilibrium = find_equilibrium(law, q) if len(q) > 1 else q
    linear: Linearisation = linearise(law, equilibrium)
    return linear


def _begin(law: Any, q: FloatArray, name: str | None) -> _Here:
    linear = _linearised(law, q)
    if name is not None:
        ensure_known("mode", name, tuple(mode.name for mode in linear.modes))
        return _Here(linear, next(mode for mode in linear.modes if mode.name == name))
    swinging_modes = [mode for mode in linear.modes if mode.frequency > mode.error]
    if not swinging_modes:
        raise SolverError("no mode swings with the law's own gains: expected mode=, the name of one that creeps")
    return _Here(linear, swinging_modes[0])


def _follow(law: Any, here: _Here) -> _Here:
    """Return the continuation of a mode at another gain, by the least change of eigenvalue and shape."""
    linear = _linearised(law, here.linear.q)

    def change(mode: Mode) -> float:
        overlap = abs(np.vdot(mode.shape, here.mode.shape)) / np.linalg.norm(mode.shape) / _norm(here.mode)
        distance = abs(_upper(mode) - _upper(here.mode)) / max(abs(mode.eigenvalue), abs(here.mode.eigenvalue))
        return float(distance + 1.0 - overlap)

    return _Here(linear, min(linear.modes, key=change))


def _norm(mode: Mode) -> float:
    return float(np.linalg.norm(mode.shape))


def _upper(mode: Mode) -> complex:
    return complex(mode.eigenvalue.real, mode.frequency)


def _refine(law: Any, name: str, ratio: float, ends: tuple[float, float], here: _Here) -> DampedGain:
    """Return the gain within a bracket at which the followed mode has the damping ratio."""
    from scipy.optimize import brentq

    def excess(gain: float) -> float:
        return _follow(_with(law, name, gain), here).mode.damping_ratio - ratio

    gain = float(brentq(excess, *ends, xtol=_EXACT * min(ends), rtol=_EXACT))
    return DampedGain(gain, _with(law, name, gain), _follow(_with(law, name, gain), here).mode)
