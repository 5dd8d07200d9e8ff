"""Bounded search space of initial states and law parameters."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import log
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_positive
from flockana.laws.first_order_law import first_order, start_velocities
from flockana.recorded.law_parameters import law_parameter, with_parameter
from flockana.scenarios import Scenario

STATE = ("q", "p")
_ROOM = 0.1  # by which the flock's box is widened on every side, of its longest side
_FASTER = 2.0  # the bound on velocities, over the largest component at the start


@dataclass(frozen=True, eq=False)
class Space:
    """Unit cube that parametrises initial states, and parameters of the law, within bounds.

    Parameters
    ----------
    scenario : Scenario
        What is not varied stays as it is here.
    vary : tuple of str
        Of the state, what is varied: ``"q"``, ``"p"``, both or none.
    low, high : ndarray, shape (K,)
        Bounds of its coordinates, in the order of `vary`.
    parameters : mapping of str to (float, float)
        Bounds of the law's parameters by dotted name; the scale is logarithmic where both are positive.
    """

    scenario: Scenario
    vary: tuple[str, ...]
    low: FloatArray
    high: FloatArray
    parameters: Mapping[str, tuple[float, float]]

    @property
    def dimension(self) -> int:
        """Number of coordinates of the search space."""
        return len(self.low) + len(self.parameters)

    @property
    def start(self) -> FloatArray:
        """Point of the unit cube nearest to the scenario's own start, shape (D,)."""
        state = {"q": self.scenario.q0, "p": self.scenario.p0}
        x = np.concatenate([np.empty(0), *(state[name].ravel() for name in self.vary)])
        values = (float(law_parameter(self.scenario.law, name)) for name in self.parameters)
        shares = [_share(value, *bounds) for value, bounds in zip(values, self.parameters.values(), strict=True)]
        return np.clip(np.concatenate([(x - self.low) / (self.high - self.low), shares]), 0.0, 1.0)

    def case(self, point: FloatArray) -> Scenario:
        """Return the scenario with the initial state and the law parameters of a point of the search space.

        Parameters
        ----------
        point : ndarray, shape (D,)
            Of the unit cube.

        Raises
        ------
        ArgumentError
            If the law refuses the parameters.
        """
        shape, law, k = self.scenario.q0.shape, self.scenario.law, len(self.low)
        x = self.low + point[:k] * (self.high - self.low)
        values = np.split(x, max(1, len(self.vary)))
        state: dict[str, Any] = {f"{name}0": x.reshape(shape) for name, x in zip(self.vary, values)}  # noqa: B905  # no values for no name
        for share, (name, bounds) in zip(point[k:].tolist(), self.parameters.items(), strict=True):
            law = with_parameter(law, name, _value(share, *bounds))
        if first_order(law) is not None:
            state["p0"] = start_velocities(law, self.scenario.t_span[0], state.get("q0", self.scenario.q0), None)
        return replace(self.scenario, law=law, **state)


def search_space(
    scenario: Scenario,
    *,
    vary: Iterable[str] = STATE,
    region: Any = None,
    speed: float | None = None,
    parameters: Mapping[str, tuple[float, float]] | None = None,
) -> Space:
    """Return the search space about a scenario's start (arguments as in `falsify`).

    Parameters
    ----------
    scenario : Scenario
        Where the search begins.
    vary : iterable of str
        ``"q"``, ``"p"``.
    region : float or (low, high), optional
        Of the positions.
    speed : float, optional
        Largest component of a velocity.
    parameters : mapping of str to (float, float), optional
        Bounds by dotted name.

    Raises
    ------
    ArgumentError
        On bad bounds, names that the law does not have, or nothing to vary.

    Examples
    --------
    >>> from flockana.scenarios import scenario
    >>> search_space(scenario("hexagon"), vary=["p"], parameters={"gains.c1_alpha": (1.0, 100.0)}).dimension
    15
    """
    names = (vary,) if isinstance(vary, str) else tuple(vary) if isinstance(vary, Iterable) else (repr(vary),)
    if not set(names) <= set(STATE) or len(set(names)) < len(names):
        raise ArgumentError(f"vary = {vary!r}: expected 'q', 'p', both, or () for parameters alone")
    if first_order(scenario.law) is not None:  # velocities are those of the places
        names = tuple(name for name in names if name != "p")
    ranges = {name: _range(scenario.law, name, bounds) for name, bounds in (parameters or {}).items()}
    if not names and not ranges:
        raise ArgumentError("nothing is varied: expected vary=('q', 'p') or parameters={'gains.c1_alpha': (1, 50)}")
    box = {"q": _region(region, scenario.q0), "p": _speeds(speed, scenario.p0)}
    low, high = (np.concatenate([np.empty(0), *(box[name][k].ravel() for name in names)]) for k in (0, 1))
    return Space(scenario, names, low, high, ranges)


def _share(value: float, low: float, high: float) -> float:
    return log(value / low) / log(high / low) if low > 0.0 < value else (value - low) / (high - low)


def _value(share: float, low: float, high: float) -> float:
    value = low * (high / low) ** share if low > 0.0 else low + share * (high - low)
    return min(max(value, low), high)


def _ends(name: str, given: Any) -> tuple[Any, Any]:
    try:
        low, high = given
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} = {given!r}: expected two bounds (low, high)") from None
    return low, high


def _range(law: Any, name: str, given: Any) -> tuple[float, float]:
    low, high = (ensure_finite_scalar(name, end) for end in _ends(name, given))
    if not low < high:
        raise ArgumentError(f"{name} = ({low:g}, {high:g}): expected low < high")
    try:
        with_parameter(law, name, float(law_parameter(law, name)))
    except (AttributeError, TypeError, ValueError):
        raise ArgumentError(
            f"{name}: {law.title} has no such number; expected a dotted name, such as gains.c1_alpha"
        ) from None
    return low, high


def _region(region: Any, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return lower and upper bounds of each agent's position in the search space, two arrays (n, m)."""
    if region is None:
        low, high = q.min(axis=0), q.max(axis=0)
        region_margin = _ROOM * float((high - low).max()) or 1.0
        return np.broadcast_to(low - region_margin, q.shape), np.broadcast_to(high + region_margin, q.shape)
    if isinstance(region, int | float | np.number):
        region_radius, farthest = ensure_positive("region", region), float(np.abs(q).max())
        low, high = q - region_radius, q + region_radius
        fault = (
            f"region = {region_radius:g}: expected more than the rounding of positions up to {farthest:.3g}, such as "
            f"{max(1e-9 * farthest, 1e-9):.1g}; vary='p' leaves positions as they are"
        )
    else:
        low, high = (np.broadcast_to(_corner(end, q.shape[1]), q.shape) for end in _ends("region", region))
        fault = f"region = ({low[0]}, {high[0]}): expected low < high on every axis"
    if not np.all(low < high):
        raise ArgumentError(fault)
    _ensure_width("region", region, low, high)
    return low, high


def _corner(end: Any, m: int) -> FloatArray:
    try:
        corner = np.broadcast_to(np.asarray(end, dtype=np.float64), (m,))
    except (TypeError, ValueError):
        raise ArgumentError(f"region = {end!r}: expected a number or {m} of them for each corner") from None
    if not np.isfinite(corner).all():
        raise ArgumentError(f"region = {end!r}: expected finite numbers")
    return corner


def _speeds(speed: Any, p: FloatArray) -> tuple[FloatArray, FloatArray]:
    bound = _FASTER * float(np.abs(p).max()) or 1.0 if speed is None else ensure_positive("speed", speed)
    high = np.full(p.shape, bound)
    _ensure_width("speed", bound, -high, high)
    return -high, high


def _ensure_width(name: str, given: Any, low: FloatArray, high: FloatArray) -> None:
    if not np.all(high / 2.0 - low / 2.0 < np.finfo(float).max / 2.0):  # halves: they cannot overflow themselves
        raise ArgumentError(f"{name} = {given}: expected bounds whose difference is a finite number, so closer ones")
