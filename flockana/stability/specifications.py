"""Gains of the γ-agent that meet specifications: decay, delay, sampling period, noise, overshoot; which one binds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from math import exp, inf, pi, sqrt
from typing import Any

import numpy as np

from flockana.base.checks import ensure_count, ensure_points, ensure_positive
from flockana.base.errors import ArgumentError
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.stability.blocks import law_blocks
from flockana.stability.delay import delay_margin, delay_system
from flockana.stability.linearise import linearise
from flockana.stability.norms import disturbance_system, h2_norm
from flockana.stability.sampling import sampling_margin
from flockana.stability.translational import CentreOfMass


@dataclass(frozen=True)
class Specifications:
    """What a flock must do; None where nothing is asked.

    Parameters
    ----------
    decay : float, optional
        Least decay rate of the slowest mode, per time unit.
    delay : float, optional
        Delay of everything that the flock must bear.
    period : float, optional
        Sampling period that it must bear (zero-order hold).
    h2 : float, optional
        Largest H₂ norm from forces on the agents to the shape.
    overshoot : float, optional
        Largest overshoot of the centre after a step of the γ-agent, as a share of the step.

    Raises
    ------
    ArgumentError
        On a specification that is not positive, or if there is none.

    Examples
    --------
    >>> Specifications(decay=0.5, period=0.02).asked
    ('decay', 'period')
    """

    decay: float | None = None
    delay: float | None = None
    period: float | None = None
    h2: float | None = None
    overshoot: float | None = None

    def __post_init__(self) -> None:
        for name in self.asked:
            object.__setattr__(self, name, ensure_positive(name, getattr(self, name)))
        if not self.asked:
            raise ArgumentError("no specification is given: expected one of decay, delay, period, h2, overshoot")

    @property
    def asked(self) -> tuple[str, ...]:
        """Names of what is asked."""
        return tuple(field.name for field in fields(self) if getattr(self, field.name) is not None)


@dataclass(frozen=True)
class SpecifiedGains:
    """Gains found for specifications.

    Parameters
    ----------
    gains : Gains
        With the c1γ and c2γ found.
    reached : mapping of str to float
        What the flock does with them, by specification.
    room : mapping of str to float
        Share by which each is met; negative where it is not.
    """

    gains: Gains
    reached: Mapping[str, float]
    room: Mapping[str, float]

    @property
    def met(self) -> bool:
        """Whether all are met."""
        return min(self.room.values()) >= 0.0

    @property
    def binding(self) -> str:
        """Specification with the least room."""
        return min(self.room, key=lambda name: self.room[name])


def specified_gains(
    law: Algorithm2, q: Any, asked: Specifications, *, bounds: tuple[float, float] = (0.1, 20.0), grid: int = 6
) -> SpecifiedGains:
    """Choose c1γ and c2γ, alike for all agents, so that the specification with the least room has the most.

    On a grid of gains, geometric between the bounds, and from its best point by Nelder and Mead's method; the
    equilibrium is found anew for each choice. A local search: what it does not meet may be met elsewhere.

    Parameters
    ----------
    law : Algorithm2
        With one gain for all; its other gains stay.
    q : array_like, shape (n, m)
        Where the search for equilibria begins.
    asked : Specifications
        What is asked.
    bounds : (float, float)
        Least and greatest gain, above 0.
    grid : int
        Values of each gain on the grid.

    Raises
    ------
    ArgumentError
        On another law, or bounds that are none.

    Examples
    --------
    One agent: of the gains up to 20 the least overshoot with a decay rate of 1 is none at all.

    >>> from flockana.environment.targets import StaticTarget
    >>> one = Algorithm2(target=StaticTarget((0.0,)))
    >>> found = specified_gains(one, [[0.0]], Specifications(decay=1.0, period=0.1))
    >>> found.met, found.binding in ("decay", "period")
    (True, True)
    """
    from scipy.optimize import minimize

    if not isinstance(law, Algorithm2):
        raise ArgumentError(f"law = {law!r}: expected Algorithm2(...)")
    if not isinstance(asked, Specifications):
        raise ArgumentError(f"asked = {asked!r}: expected Specifications(decay=..., ...)")
    q, count = ensure_points("q", q), ensure_count("grid", grid)
    low, high = (ensure_positive("bounds", x) for x in bounds)
    if not low < high:
        raise ArgumentError(f"bounds = ({low:g}, {high:g}): expected least < greatest")

    def room(logs: Any) -> float:
        c1, c2 = np.exp(np.clip(logs, np.log(low), np.log(high))).tolist()
        return min(_tried(law, q, asked, c1, c2).room.values())

    axis = np.linspace(np.log(low), np.log(high), count)
    best = max(((a, b) for a in axis for b in axis), key=room)
    limits: Any = {"maxfev": 60, "xatol": 1e-3}
    found: Any = minimize(_less(room), np.array(best, dtype=np.float64), method="Nelder-Mead", options=limits)
    chosen = max((np.array(best), found.x), key=room)
    c1, c2 = np.exp(np.clip(chosen, np.log(low), np.log(high))).tolist()
    return _tried(law, q, asked, c1, c2)


def _less(room: Callable[[Any], float]) -> Callable[[Any], float]:
    """Return the negative of a function, to be minimised."""
    return lambda x: -room(x)


def _tried(law: Algorithm2, q: Any, asked: Specifications, c1: float, c2: float) -> SpecifiedGains:
    gains = replace(law.gains, c1_gamma=c1, c2_gamma=c2)
    trial = replace(law, gains=gains)
    rest = find_equilibrium(trial, q).q if len(q) > 1 else q
    reached = {name: _reached(name, trial, rest) for name in asked.asked}
    least = ("decay", "delay", "period")
    wanted = {name: float(getattr(asked, name)) for name in reached}
    room = {
        name: reached[name] / wanted[name] - 1.0 if name in least else 1.0 - reached[name] / wanted[name]
        for name in reached
    }
    return SpecifiedGains(gains, reached, {name: max(-1e3, value) for name, value in room.items()})


def _reached(name: str, law: Algorithm2, rest: Any) -> float:
    if name == "decay":
        return linearise(law, rest, allow_residual=True).decay_rate
    if name == "delay":
        return delay_margin(delay_system(law, rest, strict=False)).delay
    if name == "period":
        return sampling_margin(law, rest).period
    if name == "overshoot":
        ratio = CentreOfMass(law.gains).damping_ratio
        return exp(-pi * ratio / sqrt(1.0 - ratio * ratio)) if ratio < 1.0 else 0.0
    system = disturbance_system(law_blocks(law, rest, strict=False))
    return inf if system is None else h2_norm(system)
